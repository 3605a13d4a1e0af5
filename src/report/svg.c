/* The SVG 1.1 writer. */
#include "report/diagram.h"

void svg_escape(FILE *out, const char *text)
{
    for (const char *c = text; *c; c++)
        switch (*c) {
        case '&': fputs("&amp;", out); break;
        case '<': fputs("&lt;", out); break;
        case '>': fputs("&gt;", out); break;
        case '"': fputs("&quot;", out); break;
        default: fputc((unsigned char)*c < ' ' || *c == 127 ? '?' : *c, out);
        }
}

void svg_begin(FILE *out, double width, double height, const char *title)
{
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 "
            "%.0f %.0f\"\n"
            "     font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"11\" fill=\"none\" "
            "stroke-linecap=\"round\" stroke-linejoin=\"round\">\n",
            width, height, width, height);
    if (title) {
        fputs("<title>", out);
        svg_escape(out, title);
        fputs("</title>\n", out);
    }
    fprintf(out, "<rect width=\"%.0f\" height=\"%.0f\" fill=\"#ffffff\"/>\n", width, height);
}

void svg_end(FILE *out)
{
    fputs("</svg>\n", out);
}

void svg_line(FILE *out, double x1, double y1, double x2, double y2, const char *stroke)
{
    fprintf(out, "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" %s/>\n", x1, y1, x2, y2, stroke);
}

void svg_label(FILE *out, double x, double y, const char *anchor, const char *color, const char *text)
{
    fprintf(out, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"%s\" fill=\"%s\">", x, y, anchor, color);
    svg_escape(out, text);
    fputs("</text>\n", out);
}

double svg_key(FILE *out, double x, double y, const char *color, const char *dashes, const char *words, double width)
{
    char stroke[160];
    snprintf(stroke, sizeof stroke, "stroke=\"%s\" stroke-width=\"1.6\"%s%s%s", color,
             dashes ? " stroke-dasharray=\"" : "", dashes ? dashes : "", dashes ? "\"" : "");
    svg_line(out, x, y - 4.0, x + 22.0, y - 4.0, stroke);
    svg_label(out, x + 28.0, y, "start", SVG_INK, words);
    return x + width;
}
