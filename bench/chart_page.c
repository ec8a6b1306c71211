/* The page: the drawings, all numbers in tables, and a script that shows a mark's numbers beside it. */
#include "chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char page_style[] =
    ":root{color-scheme:light dark}\n"
    "body{margin:0 auto;max-width:1000px;padding:16px 12px 48px;color:#1f2328;background:#fff;\n"
    "font:15px/1.45 Helvetica,Arial,'Liberation Sans',sans-serif}\n"
    "h1{font-size:1.3em;margin:8px 12px}\n"
    "p{margin:8px 12px;max-width:44em}\n"
    "figure{margin:0;border-top:1px solid #d1d9e0;padding:8px 0}\n"
    "svg.facet{display:block;width:100%;height:auto;touch-action:pan-y pinch-zoom}\n"
    "svg.narrow{display:none}\n"
    "@media (max-width:699px){svg.wide{display:none}svg.narrow{display:block}body{padding:8px 4px 32px}}\n"
    "details{margin:8px 12px}\n"
    "summary{cursor:pointer;padding:6px 0}\n"
    ".scroll{overflow-x:auto}\n"
    "table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums;white-space:nowrap}\n"
    "th,td{padding:3px 8px;text-align:right;border-bottom:1px solid #e6e9ec}\n"
    "th{position:sticky;top:0;background:#fff}\n"
    ".w{text-align:left}\n"
    "#tip{position:absolute;display:none;pointer-events:none;white-space:pre-line;background:#1f2328;color:#fff;\n"
    "padding:6px 10px;border-radius:4px;font-size:13px;line-height:1.35;max-width:340px;z-index:1}\n"
    ".facet .shown{stroke:#1f2328;stroke-width:2.5;opacity:1}\n"
    "@media (prefers-color-scheme:dark){\n"
    "body{color:#e6edf3;background:#0d1117}\n"
    "figure{border-color:#3d444d}\n"
    "th,td{border-color:#21262d}\n"
    "th{background:#0d1117}\n"
    "#tip{background:#e6edf3;color:#0d1117}\n"
    ".facet .shown{stroke:#fff}\n"
    "}\n";

/* The nearest mark within reach of the pointer shows its numbers; what is the same kernel shows too. */
static const char page_script[] =
    "'use strict';\n"
    "const tip = document.getElementById('tip');\n"
    "let shown = [];\n"
    "function hide() {\n"
    "  for (const mark of shown) mark.classList.remove('shown');\n"
    "  shown = [];\n"
    "  tip.style.display = 'none';\n"
    "}\n"
    "function nearest(svg, x, y) {\n"
    "  let best = null, least = 20;\n"
    "  for (const mark of svg.querySelectorAll('[data-of]')) {\n"
    "    const b = mark.getBoundingClientRect();\n"
    "    const far = Math.hypot(x - b.left - b.width / 2, y - b.top - b.height / 2);\n"
    "    if (far < least) { least = far; best = mark; }\n"
    "  }\n"
    "  return best;\n"
    "}\n"
    "function show(event) {\n"
    "  const mark = nearest(event.currentTarget, event.clientX, event.clientY);\n"
    "  hide();\n"
    "  if (!mark) return;\n"
    "  mark.classList.add('shown');\n"
    "  shown = [mark];\n"
    "  tip.textContent = mark.dataset.tip;\n"
    "  tip.style.display = 'block';\n"
    "  const b = mark.getBoundingClientRect(), t = tip.getBoundingClientRect();\n"
    "  const most = document.documentElement.clientWidth - t.width - 4;\n"
    "  const left = Math.min(Math.max(4, b.left + b.width / 2 - t.width / 2), most);\n"
    "  const above = b.top - t.height - 10;\n"
    "  tip.style.left = left + scrollX + 'px';\n"
    "  tip.style.top = (above > 4 ? above : b.bottom + 10) + scrollY + 'px';\n"
    "}\n"
    "for (const svg of document.querySelectorAll('svg.facet')) {\n"
    "  for (const mark of svg.querySelectorAll('[data-of]')) {\n"
    "    const title = mark.querySelector('title');\n"
    "    mark.dataset.tip = title.textContent;\n"
    "    title.remove();\n"
    "  }\n"
    "  svg.addEventListener('pointermove', show);\n"
    "  svg.addEventListener('pointerdown', show);\n"
    "  svg.addEventListener('pointerleave', hide);\n"
    "}\n"
    "addEventListener('keydown', event => { if (event.key === 'Escape') hide(); });\n";

/* ---- Tables ---------------------------------------------------------------------------------------------------- */

static void cell(FILE *to, const char *text)
{
    fprintf(to, "<td>");
    svg_escape(to, text);
    fprintf(to, "</td>");
}

static void word_cell(FILE *to, const char *text)
{
    fprintf(to, "<td class=\"w\">");
    svg_escape(to, text);
    fprintf(to, "</td>");
}

/* As it stands in the file; empty where unknown. */
static void number_cell(FILE *to, const char *format, double value)
{
    char text[64] = "";
    if (!isnan(value))
        snprintf(text, sizeof text, format, value);
    cell(to, text);
}

static void begin_table(FILE *to, const char *name, const char *const *heads, int count, int words)
{
    fprintf(to, "<details><summary>");
    svg_escape(to, name);
    fprintf(to, "</summary><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"");
    svg_escape(to, name);
    fprintf(to, "\"><table><thead><tr>");
    for (int i = 0; i < count; i++)
        fprintf(to, "<th scope=\"col\"%s>%s</th>", i < words ? " class=\"w\"" : "", heads[i]);
    fprintf(to, "</tr></thead><tbody>\n");
}

static void end_table(FILE *to)
{
    fprintf(to, "</tbody></table></div></details>\n");
}

static int by_kernel_and_time(const void *a, const void *b)
{
    const kernel_row *x = *(const kernel_row *const *)a, *y = *(const kernel_row *const *)b;
    const int order = strcmp(x->kernel, y->kernel);
    return order ? order : (x->ns > y->ns) - (x->ns < y->ns);
}

static void row_cells(FILE *to, const kernel_row *r)
{
    fprintf(to, "<tr>");
    word_cell(to, r->kernel);
    word_cell(to, r->tier);
    word_cell(to, r->arch);
    cell(to, r->size);
    word_cell(to, r->layout);
    number_cell(to, "%.4g", r->ns);
    number_cell(to, "%.1f", 100 * r->spread);
    cell(to, format_rate(row_speed(r)));
    number_cell(to, "%.3g", r->cycles);
    number_cell(to, "%.3g", r->bytes);
    number_cell(to, "%.3g", r->x_literal);
    number_cell(to, "%.3g", r->x_256);
    number_cell(to, "%.3g", r->x_512);
    number_cell(to, "%.0f %%", 100 * r->fraction);
    word_cell(to, r->bound_by);
    number_cell(to, "%.2e", r->error);
    number_cell(to, "%.2e", r->p999);
    fprintf(to, "</tr>\n");
}

static void speed_table(FILE *to, const machine *m)
{
    static const char *const heads[] = {
        "kernel", "tier", "arch", "samples a call", "layout", "ns a sample", "\302\261 %", "samples/s", "cycles",
        "bytes", "\303\227 textbook", "\303\227 256 bits", "\303\227 512 bits", "of its bound", "bound by",
        "worst error", "p99.9",
    };
    char name[400];
    const kernel_row **rows = calloc((size_t)m->count + 1, sizeof *rows);
    snprintf(name, sizeof name, "Speeds and errors: %s", m->name);
    begin_table(to, name, heads, COUNT(heads), 3);
    for (int i = 0; rows && i < m->count; i++)
        rows[i] = &m->rows[i];
    if (rows)
        qsort(rows, (size_t)m->count, sizeof *rows, by_kernel_and_time);
    for (int i = 0; rows && i < m->count; i++)
        row_cells(to, rows[i]);
    end_table(to);
    free(rows);
}

static void peak_table(FILE *to, const machine *m)
{
    static const char *const heads[] = { "what", "reached", "unit" };
    char name[400];
    if (!m->peak_count)
        return;
    snprintf(name, sizeof name, "What the CPU can do at most: %s", m->name);
    begin_table(to, name, heads, COUNT(heads), 1);
    for (int i = 0; i < m->peak_count; i++) {
        fprintf(to, "<tr>");
        word_cell(to, m->peaks[i].name);
        number_cell(to, "%.4g", m->peaks[i].value);
        word_cell(to, m->peaks[i].unit);
        fprintf(to, "</tr>\n");
    }
    end_table(to);
}

static void model_table(FILE *to, const chart_data *d)
{
    static const char *const heads[] = { "family", "model", "kernel", "worst difference", "mean" };
    if (!d->ladder_count)
        return;
    begin_table(to, "Models against the richest of their family", heads, COUNT(heads), 3);
    for (int i = 0; i < d->ladder_count; i++)
        for (int k = 0; k < d->ladders[i].count; k++) {
            const model *m = &d->ladders[i].models[k];
            fprintf(to, "<tr>");
            word_cell(to, d->ladders[i].title);
            word_cell(to, m->label);
            word_cell(to, m->kernel);
            cell(to, format_percent(m->worst));
            cell(to, format_percent(m->mean));
            fprintf(to, "</tr>\n");
        }
    end_table(to);
}

static void failure_table(FILE *to, const chart_data *d)
{
    static const char *const heads[] = { "where", "along", "x", "textbook, worst", "textbook, NaN", "facet, worst" };
    if (!d->panel_count)
        return;
    begin_table(to, "Where textbook forms fail", heads, COUNT(heads), 2);
    for (int i = 0; i < d->panel_count; i++)
        for (int k = 0; k < d->panels[i].count; k++) {
            const failure_point *at = &d->panels[i].points[k];
            fprintf(to, "<tr>");
            word_cell(to, d->panels[i].title);
            word_cell(to, d->panels[i].x);
            number_cell(to, "%.3g", at->x);
            number_cell(to, "%.2e", at->textbook);
            number_cell(to, "%.1f %%", 100 * at->lost);
            number_cell(to, "%.2e", at->facet);
            fprintf(to, "</tr>\n");
        }
    end_table(to);
}

/* ---- The page -------------------------------------------------------------------------------------------------- */

void page_write(FILE *to, const drawing *drawings, int count, const chart_data *d)
{
    fprintf(to, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<title>facet: speed against accuracy</title>\n<style>\n%s%s</style>\n</head>\n<body>\n"
            "<h1>facet: speed against accuracy</h1>\n", svg_style, page_style);
    for (int i = 0; i < count; i++) {
        fprintf(to, "<figure id=\"%s\">\n", drawings[i].name);
        svg_write(&drawings[i].wide, to, false);
        svg_write(&drawings[i].narrow, to, false);
        fprintf(to, "</figure>\n");
    }
    for (int i = 0; i < d->machine_count; i++) {
        speed_table(to, &d->machines[i]);
        peak_table(to, &d->machines[i]);
    }
    model_table(to, d);
    failure_table(to, d);
    fprintf(to, "<div id=\"tip\" role=\"status\"></div>\n<script>\n%s</script>\n</body>\n</html>\n", page_script);
}
