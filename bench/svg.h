/* SVG that stands alone and looks right on light and dark ground: text that is measured and wrapped, lines, marks. */
#ifndef SVG_H
#define SVG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A drawing in the making. It grows downwards. */
typedef struct svg {
    FILE *out;                   /* its body, so far */
    char *body;
    size_t length;
    char title[400];
    double width, height;
    double size;                 /* of ordinary text */
    bool narrow;                 /* for a phone */
} svg;

typedef enum svg_shape { SVG_DISC, SVG_SQUARE, SVG_DIAMOND, SVG_CROSS } svg_shape;

/* The colours and weights of everything, as CSS: of drawings, and of pages around them. */
extern const char svg_style[];

void svg_begin(svg *s, bool narrow);

/* The body is complete. */
void svg_end(svg *s);

/* Writes an <svg> element: alone, with its style and title, or as a part of a page that has them. */
void svg_write(const svg *s, FILE *to, bool alone);

/* Writes text with what XML has escaped; what is no UTF-8 or a control character is '?'. */
void svg_escape(FILE *to, const char *text);

/* About how wide text will be. */
double text_width(const char *text, double size, bool bold);

/* A line of text: `class` is of svg_style, "strong" is bold; `anchor` is start, middle or end. */
void svg_text(svg *s, double x, double y, const char *class, double size, const char *anchor, const char *text);

/* The same of a bold name and what follows it, which may be empty. */
void svg_named_text(svg *s, double x, double y, const char *class, double size, const char *anchor, const char *name,
                    const char *more);

/* The length of the part of `text` that fits a width: up to a space, a slash or a plus, or all of it, or one word. */
size_t text_break(const char *text, double size, bool bold, double width);

/* Text in lines, the first one's baseline at y; returns the last one's. */
double svg_paragraph(svg *s, double x, double y, double width, const char *class, double size, const char *text);

void svg_line(svg *s, const char *class, double x0, double y0, double x1, double y1);

/* A mark; what it stands for (NULL: nothing), for scripts, and what is shown where it is pointed at. */
void svg_mark(svg *s, svg_shape shape, const char *class, double x, double y, double radius, const char *of,
              const char *tip);

#endif
