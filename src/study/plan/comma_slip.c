/* Recognises decimal commas in the lists of a study: [1,5, 2,5], meant as 1.5 and 2.5, reads as four values. */
#include "base/array.h"
#include "base/number.h"
#include "study/plan/grid.h"
#include <stdio.h>
#include <string.h>

static bool is_value(const node *n)
{
    double value;
    return n->kind == NODE_SCALAR && !n->quoted && number_parse_real(n->text, &value);
}

static bool is_integer(const node *n, bool with_sign)
{
    if (!is_value(n))
        return false;
    const char *digits = n->text + (with_sign && *n->text == '-');
    return *digits && digits[strspn(digits, "0123456789")] == 0;
}

static bool has_point(const node *n)
{
    return is_value(n) && strchr(n->text, '.');
}

static bool list_has_point(const node *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (has_point(list->items[i]))
            return true;
    return false;
}

/* Whether only a comma, without a space, separates item i from the next. */
static bool touches_next(const node *list, size_t i)
{
    const node *a = list->items[i], *b = list->items[i + 1];
    return a->kind == NODE_SCALAR && !a->quoted && a->line == b->line &&
           b->column == a->column + (long)strlen(a->text) + 1;
}

static bool is_spaced(const node *list)
{
    for (size_t i = 0; i + 1 < list->count; i++)
        if (!touches_next(list, i))
            return true;
    return false;
}

/* Whether the values increase or decrease steadily. joined, unless NULL, replaces the items `at` and `at + 1`. */
static bool is_steady(const node *list, size_t at, const char *joined)
{
    int direction = 0;
    double before = 0;
    for (size_t i = 0, count = 0; i < list->count; i++) {
        double value;
        if (joined && i == at + 1)
            continue;
        if (!number_parse_real(joined && i == at ? joined : list->items[i]->text, &value))
            return false;
        const int step = value > before ? 1 : -1;
        if (count > 0 && (value == before || (direction && step != direction)))
            return false;
        direction = count > 0 ? step : 0;
        before = value;
        count++;
    }
    return true;
}

bool comma_slip_at(const node *list, size_t i, bool real, char joined[COMMA_SLIP_TEXT_MAX])
{
    if (list->kind != NODE_LIST || i + 1 >= list->count)
        return false;
    const node *a = list->items[i], *b = list->items[i + 1];
    if (!is_integer(a, true) || !is_integer(b, false) || strlen(a->text) > 30 || strlen(b->text) > 30)
        return false;
    snprintf(joined, COMMA_SLIP_TEXT_MAX, "%.30s.%.30s", a->text, b->text);
    const size_t first = strlen(a->text) - (a->text[0] == '-'), second = strlen(b->text);
    if (touches_next(list, i) && second > 1 && (b->text[0] == '0' || (real && list->count == 2 && first == 1)))
        return true;
    if (!list_has_point(list))
        return false;
    return (touches_next(list, i) && is_spaced(list)) || (!is_steady(list, i, NULL) && is_steady(list, i, joined));
}

status comma_slip_note(study *s, const char *path, const node *list, bool real, diagnostic *why)
{
    char joined[COMMA_SLIP_TEXT_MAX];
    for (size_t i = 0; list->kind == NODE_LIST && i + 1 < list->count; i++) {
        if (!comma_slip_at(list, i, real, joined))
            continue;
        if (!room_for_one(&s->notes, s->note_count, sizeof *s->notes))
            return out_of_memory(why);
        study_note *one = &s->notes[s->note_count++];
        const node *a = list->items[i], *b = list->items[++i];
        *one = (study_note){.line = a->line, .column = a->column};
        snprintf(one->note.place, sizeof one->note.place, "%s", path);
        snprintf(one->note.text, sizeof one->note.text, "%s and %s are two values", a->text, b->text);
        snprintf(one->note.remedy, sizeof one->note.remedy, "did you mean %s?", joined);
    }
    return STATUS_OK;
}
