/* Sizes of a figure, in CSS pixels: panels in a grid, the title above, the key or the color bar on the right, captions
 * below. */
#include "study/plot_parts.h"
#include "base/text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LETTER = 7,
    TITLE_LETTER = 8,
    TURNED_LETTER = 9,
    TITLE = 36,
    LINE = 13 /* of captions */,
    GAP = 24,
    PANEL_TITLE = 26,
    WIDTH_MIN = 560
};

typedef struct grid {
    size_t count, columns, rows;
    int width, height;       /* of a panel */
    int left, right, bottom; /* margins of the whole, without captions */
} grid;

static int longest(const plot_axis *axis)
{
    size_t most = 0;
    for (size_t i = 0; axis && i < axis->count; i++)
        most = strlen(axis->texts[i]) > most ? strlen(axis->texts[i]) : most;
    return (int)most;
}

static int limited(int value, int least, int most)
{
    return value < least ? least : value > most ? most : value;
}

/* --- panels --- */

static const char *last_part(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot ? dot + 1 : path;
}

/* "render.accel = bvh, render.width = 80"; names shortened if the whole is too long. */
static char *panel_title(const plot_plan *p, size_t panel, bool whole)
{
    char *title = strdup("");
    for (size_t i = p->faceted_count; title && i-- > 0;) {
        const plot_axis *axis = p->faceted[i];
        char *longer = text_format("%s = %s%s%s", whole ? axis->name : last_part(axis->name),
                                   axis->texts[panel % axis->count], title[0] ? ", " : "", title);
        panel /= axis->count;
        free(title);
        title = longer;
    }
    return title;
}

/* Names the panels, and widens them for names that are too long even when shortened. */
static bool name_panels(plot_plan *p, int *width)
{
    int letters = 0;
    for (size_t i = 0; i < p->panel_count; i++) {
        if (!p->panels[i].used)
            continue;
        p->panels[i].title = panel_title(p, i, true);
        if (p->panels[i].title && (int)strlen(p->panels[i].title) * TITLE_LETTER > *width) {
            free(p->panels[i].title);
            p->panels[i].title = panel_title(p, i, false);
        }
        if (!p->panels[i].title)
            return false;
        letters = (int)strlen(p->panels[i].title) > letters ? (int)strlen(p->panels[i].title) : letters;
    }
    *width = limited(letters * TITLE_LETTER, *width, *width > 480 ? *width : 480);
    return true;
}

static void size_panels(const plot_plan *p, grid *g)
{
    static const size_t columns[] = {1, 1, 2, 3, 2, 3, 3, 4, 4, 3};
    static const int widths[] = {0, 560, 380, 300, 290, 250};
    g->columns = g->count < 10 ? columns[g->count] : g->count <= 12 ? 4 : g->count <= 25 ? 5 : 6;
    g->rows = (g->count + g->columns - 1) / g->columns;
    g->width = g->columns < 6 ? widths[g->columns] : 220;
    g->height = g->count == 1 ? 350 : g->width * 3 / 4;
    if (p->kind == PLOT_HEAT) {
        const int cell = g->count == 1 ? 68 : 50;
        g->width = limited((int)p->along->count * cell, g->count == 1 ? 420 : 170, g->width + 260);
        g->height = limited((int)p->up->count * 34, 110, 620);
    } else if (p->kind == PLOT_DOTS && p->along) {
        g->width = limited((int)(p->along->count * (p->series_count > 2 ? p->series_count * 12 : 26)), g->width, 1000);
    }
}

/* --- margins --- */

static int key_width(const plot_plan *p)
{
    int letters = p->by ? longest(p->by) : 0;
    if (!p->by && !p->published.series_count)
        return 0;
    letters = p->by && (int)strlen(p->by->name) > letters + 4 ? (int)strlen(p->by->name) - 4 : letters;
    for (size_t i = 0; i < p->published.series_count; i++)
        letters = limited((int)strlen(p->published.names[i]) + 12, letters, 36);
    return limited(letters * LETTER + 54, 120, 330);
}

/* Letters of the longest tic label of the y axis. */
static int y_letters(const plot_plan *p)
{
    const double most = fmax(fabs(p->y.from), fabs(p->y.to));
    const int whole = most >= 1 && most < 1e7 ? 1 + (int)log10(most) : 5;
    return limited(whole + (p->y.from < 0) + (p->y.to - p->y.from < 3 || p->y.from < 0.1 ? 1 : 0), 4, 8);
}

static void find_margins(const plot_plan *p, grid *g)
{
    const int slot = p->along ? g->width / (int)p->along->count : g->width;
    const bool words = p->kind != PLOT_LINES;
    const bool turned = words && longest(p->along) * LETTER > slot;
    g->left = 46 + LETTER * (p->kind == PLOT_HEAT ? longest(p->up) : y_letters(p));
    g->right = 18 + (p->kind == PLOT_HEAT ? 96 : key_width(p));
    g->bottom = 50 + (turned ? limited(longest(p->along) * TURNED_LETTER - 8, 0, 240) : 0);
}

static void place_panels(plot_plan *p, const grid *g, int captions)
{
    size_t place = 0;
    for (size_t i = 0; i < p->panel_count; i++) {
        plot_panel *panel = &p->panels[i];
        if (!panel->used)
            continue;
        const size_t row = place / g->columns, column = place % g->columns;
        const double left = g->left + (double)column * (g->width + GAP);
        const double below = (double)(g->rows - 1 - row) * (g->height + PANEL_TITLE + GAP / 2.0);
        panel->left = left / p->width;
        panel->right = (left + g->width) / p->width;
        panel->bottom = (captions + g->bottom + below) / p->height;
        panel->top = (captions + g->bottom + below + g->height) / p->height;
        panel->shows_x = place + g->columns >= g->count;
        panel->shows_y = column == 0;
        place++;
    }
    p->key_left = (g->left + (double)g->columns * (g->width + GAP) - GAP + 14) / p->width;
    p->key_top = 1.0 - (double)(TITLE + (g->count > 1 ? PANEL_TITLE : 0)) / p->height;
}

status plot_layout(plot_plan *p, diagnostic *why)
{
    grid g = {0};
    for (size_t i = 0; i < p->panel_count; i++)
        g.count += p->panels[i].used;
    if (g.count > PLOT_PANELS_MAX)
        return diagnose_at(why, p->s->path, STATUS_BAD_INPUT,
                           "show a part of the grid with --where PATH=VALUE, or choose --x and --by",
                           "%zu panels are more than %d", g.count, PLOT_PANELS_MAX);
    size_panels(p, &g);
    if (!name_panels(p, &g.width))
        return out_of_memory(why);
    find_margins(p, &g);
    p->width = g.left + (int)g.columns * (g.width + GAP) - GAP + g.right;
    p->width = p->width < WIDTH_MIN ? WIDTH_MIN : p->width;
    TRY(plot_captions(p, why));
    const int captions = (int)p->caption_count * LINE + 10, titles = g.count > 1 ? PANEL_TITLE : 0;
    p->height =
        TITLE + titles + (int)g.rows * g.height + (int)(g.rows - 1) * (PANEL_TITLE + GAP / 2) + g.bottom + captions;
    place_panels(p, &g, captions);
    return STATUS_OK;
}
