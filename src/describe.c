/* Plans and errors in words. Nothing here calls libc: numbers are formatted by hand. */
#include "internal.h"

#include "../arch/environment.h"

/* Writes as snprintf does: counts everything, stores what fits. */
typedef struct { char *text; size_t size, length; } writer;

static void put_char(writer *w, char c)
{
    if (w->length + 1 < w->size) w->text[w->length] = c;
    w->length++;
}

static void put(writer *w, const char *s)
{
    while (*s) put_char(w, *s++);
}

static void put_unsigned(writer *w, unsigned n)
{
    if (n >= 10) put_unsigned(w, n / 10);
    put_char(w, (char)('0' + n % 10));
}

/* Six significant digits, as %g prints them. */
static void put_number(writer *w, float x)
{
    if (!finite(x)) {
        put(w, "not finite");
        return;
    }
    if (x < 0.0f) put_char(w, '-');
    double scaled = x < 0.0f ? -(double)x : (double)x;
    int exponent = 5;
    if (x == 0.0f) {
        put_char(w, '0');
        return;
    }
    for (; scaled >= 999999.5; exponent++) scaled /= 10.0;
    for (; scaled < 99999.95; exponent--) scaled *= 10.0;
    unsigned digits = (unsigned)(scaled + 0.5), power = 100000;

    const bool scientific = exponent < -4 || exponent > 5;
    const int point = scientific ? 0 : exponent;         /* digits before the decimal point, less one */
    if (point < 0) put(w, "0.");
    for (int zeros = point + 1; zeros < 0; zeros++) put_char(w, '0');
    for (int place = 0; power && (digits || place <= point); place++, power /= 10) {
        if (place == point + 1 && point >= 0) put_char(w, '.');
        put_char(w, (char)('0' + digits / power));
        digits %= power;
    }
    if (scientific) {
        put(w, exponent < 0 ? "e-" : "e+");
        put_unsigned(w, (unsigned)(exponent < 0 ? -exponent : exponent));
    }
}

static void put_numbers(writer *w, const char *name, const float *a, int count)
{
    put(w, name);
    for (int c = 0; c < count; c++) {
        put_char(w, ' ');
        put_number(w, a[c]);
    }
}

/* A parameter that the models or other parameters are made of: its numbers, or where they come from. */
static void put_parameter(writer *w, const plan_fields *p, uint32_t stream, const char *name, const float *a, int count)
{
    const uint32_t extinction = p->fresnel == FACET_FRESNEL_CONDUCTOR ? FACET_STREAM_K : 0;
    const uint32_t fitted = p->fits ? FACET_STREAM_ETA | extinction : 0;
    if (!((p->needed | p->sources | fitted) & stream)) return;
    put(w, ", ");
    if (p->promised & stream || p->derived & stream) {
        put(w, name);
        put(w, p->promised & stream ? " per sample" : " made per sample");
    } else {
        put_numbers(w, name, a, count);
    }
}

static size_t finish(writer *w)
{
    if (w->size) w->text[w->length < w->size ? w->length : w->size - 1] = 0;
    return w->length;
}

static void describe_convention(writer *w, const plan_fields *p)
{
    if (p->convention == FACET_CONVENTION_DIRECT) return;
    put(w, "convention: ");
    put(w, facet_word(FACET_KIND_CONVENTION, p->convention));
    put_parameter(w, p, FACET_STREAM_BASE, "base", p->base, 3);
    put_parameter(w, p, FACET_STREAM_METALLIC, "metallic", &p->metallic, 1);
    put_parameter(w, p, FACET_STREAM_ROUGHNESS, "roughness", &p->roughness, 1);
    put_parameter(w, p, FACET_STREAM_SPECULAR_LEVEL, "specular level", &p->specular_level, 1);
    put_parameter(w, p, FACET_STREAM_GLOSSINESS, "glossiness", &p->glossiness, 1);
    put(w, "\n");
}

static void describe_diffuse(writer *w, const plan_fields *p)
{
    put(w, "diffuse: ");
    put(w, facet_word(FACET_KIND_DIFFUSE, p->diffuse));
    put_parameter(w, p, FACET_STREAM_ALBEDO, "albedo", p->albedo, 3);
    put_parameter(w, p, FACET_STREAM_SIGMA, "sigma", &p->sigma, 1);
    if (p->needed & FACET_STREAM_SIGMA && !(p->promised & FACET_STREAM_SIGMA))
        put_numbers(w, ", A and B", p->terms, 2);
    put(w, "\n");
}

static void describe_fresnel(writer *w, const plan_fields *p)
{
    put(w, ", Fresnel ");
    put(w, facet_word(FACET_KIND_FRESNEL, p->fresnel));
    put_parameter(w, p, FACET_STREAM_F0, "f0", p->f0, 3);
    if (p->number_from & F0_FROM_ETA) put(w, " (from eta and k)");
    if (p->fresnel_properties & F90) put_numbers(w, ", f90", &p->f90, 1);
    if (p->fresnel_properties & F82) put_numbers(w, ", f82", p->f82, 3);
    if (p->number_from & F82_FROM_ETA) put(w, " (from eta and k)");
    put_parameter(w, p, FACET_STREAM_ETA, "eta", p->eta, 3);
    if (p->number_from & ETA_FROM_F0) put(w, " (from f0)");
    put_parameter(w, p, FACET_STREAM_K, "k", p->k, 3);
    if (!(p->fresnel_properties & MEDIA)) return;
    put_numbers(w, ", eta outside", &p->eta_outside, 1);
    if (p->polarisation < 0.0f || p->polarisation > 0.0f) put_numbers(w, ", polarisation", &p->polarisation, 1);
}

static void describe_specular(writer *w, const plan_fields *p)
{
    put(w, "specular: ");
    put(w, facet_word(FACET_KIND_DISTRIBUTION, p->distribution));
    if (p->distribution) {
        put_parameter(w, p, FACET_STREAM_ALPHA, "alpha", &p->alpha, 1);
        if (p->clamped_alpha) put(w, " (clamped)");
        put_parameter(w, p, FACET_STREAM_ALPHA_Y, "alpha_y", &p->alpha_y, 1);
        put_parameter(w, p, FACET_STREAM_EXPONENT, "exponent", &p->exponent, 1);
        if (p->scale < 1.0f || p->scale > 1.0f) put_numbers(w, ", times", &p->scale, 1);
        if (p->visibility != VISIBILITY_NONE) {
            put(w, ", masking ");
            put(w, facet_word(FACET_KIND_MASKING, p->masking));
        }
        describe_fresnel(w, p);
    }
    put(w, "\n");
}

/* How a term that has an exact formula is evaluated, and why so. */
static void describe_fit(writer *w, const plan_fields *p)
{
    if (!(p->fresnel_properties & MEDIA)) return;
    put(w, "Fresnel: ");
    if (p->fits) {
        put(w, p->fits == 1 ? "a rational function of the cosine" : "a rational function of the cosine per channel");
        put_numbers(w, ", within", &p->fit_error, 1);
        put(w, " of the exact term\n");
        return;
    }
    put(w, "exact; ");
    if (p->tier == FACET_TIER_STRICT) {
        put(w, "the strict tier has no fits\n");
    } else if (index_per_sample(p)) {
        put(w, "what comes per sample has no fit\n");
    } else {
        put_numbers(w, "no fit is within", (float[]){ FIT_LIMIT }, 1);
        put(w, "\n");
    }
}

/* Not inlined: its arithmetic stays between environment_enter and environment_leave. */
static __attribute__((noinline)) size_t describe(const plan_fields *p, char *text, size_t size)
{
    writer w = { text, size, 0 };
    put(&w, "kernel: f32 ");
    put(&w, facet_word(FACET_KIND_ARCH, p->arch));
    put(&w, p->tier == FACET_TIER_STRICT ? " strict: the same bytes on every architecture\n" : " fast\n");
    describe_convention(&w, p);
    describe_diffuse(&w, p);
    describe_specular(&w, p);
    describe_fit(&w, p);
    if (p->coupled) put(&w, "coupled: diffuse times 1 - F\n");
    if (p->emits) {
        put_numbers(&w, "emission:", p->emission, 3);
        put(&w, "\n");
    }
    return finish(&w);
}

size_t facet_plan_describe(const facet_plan *plan, char *text, size_t size)
{
    const plan_fields *p = (const plan_fields *)plan;
    if (!p || !plan_kernel(p)) return 0;
    environment callers = environment_enter();
    size_t length = describe(p, text, size);
    environment_leave(callers);
    return length;
}

size_t facet_error_describe(const facet_error *error, char *text, size_t size)
{
    writer w = { text, size, 0 };
    const facet_error none = { FACET_OK, 0, -1 };
    if (!error) error = &none;
    if (error->field) {
        put(&w, error->field);
        if (error->index >= 0) {
            put_char(&w, '[');
            put_unsigned(&w, (unsigned)error->index);
            put_char(&w, ']');
        }
        put(&w, ": ");
    }
    const char *words = facet_word(FACET_KIND_STATUS, (int)error->code);
    put(&w, words ? words : "unknown status");
    return finish(&w);
}
