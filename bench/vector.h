/* Three doubles. */
#ifndef VECTOR_H
#define VECTOR_H

#include <math.h>

static inline double vector_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vector_cross(double out[3], const double a[3], const double b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void vector_subtract(double out[3], const double a[3], const double b[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

/* a += s b */
static inline void vector_add_scaled(double a[3], double s, const double b[3])
{
    for (int i = 0; i < 3; i++)
        a[i] += s * b[i];
}

/* Zero stays zero. */
static inline void vector_normalise(double v[3])
{
    double length = sqrt(vector_dot(v, v));
    for (int i = 0; i < 3 && length > 0; i++)
        v[i] /= length;
}

static inline void vector_widen(double out[3], const float v[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

static inline void vector_narrow(float out[3], const double v[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (float)v[i];
}

#endif
