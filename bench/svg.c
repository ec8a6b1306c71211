#include "svg.h"
#include "console.h"

#include <stdlib.h>
#include <string.h>

/* Okabe and Ito's colours, lighter or darker where the ground asks for it. */
const char svg_style[] =
    ".facet{font-family:Helvetica,Arial,'Liberation Sans',sans-serif;font-variant-numeric:tabular-nums}\n"
    ".facet text{fill:#1f2328;stroke:none}\n"
    ".facet .muted{fill:#59636e}\n"
    ".facet .strong{font-weight:700}\n"
    ".facet .halo{stroke:#fff;stroke-width:4px;stroke-linejoin:round;paint-order:stroke}\n"
    ".facet .ground{fill:#fff}\n"
    ".facet .grid{stroke:#e6e9ec;stroke-width:1}\n"
    ".facet .axis{stroke:#818b96;stroke-width:1}\n"
    ".facet .leader{stroke:#818b96;stroke-width:1}\n"
    ".facet .front{stroke:#59636e;stroke-width:1.5;fill:none;stroke-dasharray:2 4;stroke-linecap:round}\n"
    ".facet .curve{fill:none;stroke-width:2.5;stroke-linejoin:round}\n"
    ".facet .whisker{stroke-width:1.5;stroke-opacity:.35}\n"
    ".facet .span{stroke:#c9d0d7;stroke-width:2}\n"
    ".facet .hollow{fill:none;stroke-width:1.8}\n"
    ".facet .faint{opacity:.5}\n"
    ".facet .scalar{fill:#cc79a7;stroke:#cc79a7}\n"
    ".facet .sse2{fill:#e69f00;stroke:#e69f00}\n"
    ".facet .sse41{fill:#d55e00;stroke:#d55e00}\n"
    ".facet .avx2{fill:#009e73;stroke:#009e73}\n"
    ".facet .avx512{fill:#0072b2;stroke:#0072b2}\n"
    ".facet .neon{fill:#56b4e9;stroke:#56b4e9}\n"
    ".facet .other{fill:#59636e;stroke:#59636e}\n"
    ".facet .baseline{fill:#1f2328;stroke:#1f2328}\n"
    ".facet .curve,.facet .hollow{fill:none}\n"
    "@media (prefers-color-scheme:dark){\n"
    ".facet text{fill:#e6edf3}\n"
    ".facet .muted{fill:#9198a1}\n"
    ".facet .halo{stroke:#0d1117}\n"
    ".facet .ground{fill:#0d1117}\n"
    ".facet .grid{stroke:#21262d}\n"
    ".facet .axis,.facet .leader{stroke:#656c76}\n"
    ".facet .front{stroke:#9198a1}\n"
    ".facet .span{stroke:#3d444d}\n"
    ".facet .avx512{fill:#3ea6e6;stroke:#3ea6e6}\n"
    ".facet .avx2{fill:#12b886;stroke:#12b886}\n"
    ".facet .neon{fill:#8fd0f5;stroke:#8fd0f5}\n"
    ".facet .other{fill:#9198a1;stroke:#9198a1}\n"
    ".facet .baseline{fill:#e6edf3;stroke:#e6edf3}\n"
    ".facet .curve,.facet .hollow{fill:none}\n"
    "}\n";

void svg_begin(svg *s, bool narrow)
{
    *s = (svg){ .width = narrow ? 360 : 960, .size = narrow ? 12.5 : 14, .narrow = narrow };
    s->out = open_memstream(&s->body, &s->length);
    if (!s->out) {
        console_error("out of memory");
        exit(1);
    }
}

void svg_end(svg *s)
{
    if (fclose(s->out)) {
        console_error("out of memory");
        exit(1);
    }
}

void svg_write(const svg *s, FILE *to, bool alone)
{
    fprintf(to, "<svg class=\"facet %s\" ", s->narrow ? "narrow" : "wide");
    if (alone)
        fprintf(to, "xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" ", s->width, s->height);
    fprintf(to, "viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"", s->width, s->height);
    svg_escape(to, s->title);
    fprintf(to, "\">\n");
    if (alone) {
        fprintf(to, "<title>");
        svg_escape(to, s->title);
        fprintf(to, "</title>\n<style>\n%s</style>\n", svg_style);
    }
    fprintf(to, "<rect class=\"ground\" width=\"%.0f\" height=\"%.0f\"/>\n", s->width, s->height);
    fwrite(s->body, 1, s->length, to);
    fprintf(to, "</svg>\n");
}

/* ---- Text ------------------------------------------------------------------------------------------------------ */

/* The bytes of the UTF-8 character that text starts with; 0 where there is none that XML allows. */
static size_t character_length(const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    const size_t length = *c < 0x80 ? 1 : *c >= 0xf0 ? 4 : *c >= 0xe0 ? 3 : 2;
    if (*c < 0x20 || *c == 0x7f || (*c >= 0x80 && *c < 0xc2) || *c > 0xf4)
        return *c == '\n';
    for (size_t i = 1; i < length; i++)
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    const bool overlong = (*c == 0xe0 && c[1] < 0xa0) || (*c == 0xf0 && c[1] < 0x90);
    const bool surrogate = *c == 0xed && c[1] >= 0xa0, beyond = *c == 0xf4 && c[1] >= 0x90;
    const bool not_a_character = *c == 0xef && c[1] == 0xbf && c[2] >= 0xbe;
    return overlong || surrogate || beyond || not_a_character ? 0 : length;
}

void svg_escape(FILE *to, const char *text)
{
    while (*text) {
        const size_t length = character_length(text);
        switch (*text) {
        case '&': fputs("&amp;", to); break;
        case '<': fputs("&lt;", to); break;
        case '>': fputs("&gt;", to); break;
        case '"': fputs("&quot;", to); break;
        default: fwrite(length ? text : "?", 1, length ? length : 1, to);
        }
        text += length ? length : 1;
    }
}

/* Helvetica's advance widths from ' ' to '~', in thousandths. */
static const short advances[] = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778,
    722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278,
    278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
};

static double width_of(const char *text, size_t length, double size, bool bold)
{
    double sum = 0;
    for (size_t i = 0; i < length; i++) {
        const unsigned char c = (unsigned char)text[i];
        const bool continues = c >= 0x80 && c < 0xc0;
        sum += continues ? 0 : c >= ' ' && c <= '~' ? advances[c - ' '] : 600;
    }
    return sum / 1000 * size * (bold ? 1.07 : 1);
}

double text_width(const char *text, double size, bool bold)
{
    return width_of(text, strlen(text), size, bold);
}

size_t text_break(const char *text, double size, bool bold, double width)
{
    size_t fits = 0;
    for (size_t i = 0; text[i]; i++) {
        const size_t end = text[i] == ' ' ? i : i + 1;
        if (text[i] != ' ' && text[i] != '/' && text[i] != '+')
            continue;
        if (fits && width_of(text, end, size, bold) > width)
            return fits;
        fits = i + 1;
    }
    const size_t all = strlen(text);
    return fits && width_of(text, all, size, bold) > width ? fits : all;
}

static void begin_text(svg *s, double x, double y, const char *class, double size, const char *anchor)
{
    fprintf(s->out, "<text x=\"%.1f\" y=\"%.1f\" font-size=\"%.4g\"", x, y, size);
    if (*class)
        fprintf(s->out, " class=\"%s\"", class);
    if (strcmp(anchor, "start"))
        fprintf(s->out, " text-anchor=\"%s\"", anchor);
    fputc('>', s->out);
}

void svg_text(svg *s, double x, double y, const char *class, double size, const char *anchor, const char *text)
{
    begin_text(s, x, y, class, size, anchor);
    svg_escape(s->out, text);
    fprintf(s->out, "</text>\n");
}

void svg_named_text(svg *s, double x, double y, const char *class, double size, const char *anchor, const char *name,
                    const char *more)
{
    begin_text(s, x, y, class, size, anchor);
    fprintf(s->out, "<tspan class=\"strong\">");
    svg_escape(s->out, name);
    fprintf(s->out, "</tspan>%s", *more ? " " : "");
    svg_escape(s->out, more);
    fprintf(s->out, "</text>\n");
}

double svg_paragraph(svg *s, double x, double y, double width, const char *class, double size, const char *text)
{
    const bool bold = strstr(class, "strong");
    for (;;) {
        const size_t length = text_break(text, size, bold, width);
        char line[1024];
        snprintf(line, sizeof line, "%.*s", (int)length, text);
        svg_text(s, x, y, class, size, "start", line);
        text += length;
        if (!*text)
            return y;
        y += 1.3 * size;
    }
}

/* ---- Lines and marks ------------------------------------------------------------------------------------------- */

void svg_line(svg *s, const char *class, double x0, double y0, double x1, double y1)
{
    fprintf(s->out, "<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", class, x0, y0, x1, y1);
}

static void shape_element(FILE *out, svg_shape shape, double x, double y, double r)
{
    switch (shape) {
    case SVG_DISC: fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"", x, y, r); return;
    case SVG_SQUARE:
        fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"", x - r, y - r, 2 * r, 2 * r);
        return;
    case SVG_DIAMOND:
        fprintf(out, "<path d=\"M%.1f %.1fl%.1f %.1fl%.1f %.1fl%.1f %.1fz\"", x, y - r, r, r, -r, r, -r, -r);
        return;
    case SVG_CROSS:
        fprintf(out, "<path d=\"M%.1f %.1fl%.1f %.1fm0 %.1fl%.1f %.1f\"", x - r, y - r, 2 * r, 2 * r, -2 * r, -2 * r,
                2 * r);
        return;
    }
}

void svg_mark(svg *s, svg_shape shape, const char *class, double x, double y, double radius, const char *of,
              const char *tip)
{
    shape_element(s->out, shape, x, y, radius);
    fprintf(s->out, " class=\"%s%s\"", class, shape == SVG_SQUARE || shape == SVG_CROSS ? " hollow" : "");
    if (of) {
        fprintf(s->out, " data-of=\"");
        svg_escape(s->out, of);
        fputc('"', s->out);
    }
    if (!tip) {
        fprintf(s->out, "/>\n");
        return;
    }
    fprintf(s->out, "><title>");
    svg_escape(s->out, tip);
    fprintf(s->out, "</title></%s>\n", shape == SVG_DISC ? "circle" : shape == SVG_SQUARE ? "rect" : "path");
}
