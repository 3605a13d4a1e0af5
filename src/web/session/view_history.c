#include "web/session/view_history.h"

#include <stdio.h>
#include <string.h>

bool camera_equal(const struct camera *a, const struct camera *b)
{
    return memcmp(a, b, sizeof *a) == 0; /* numbers of eight bytes only, so without padding */
}

static void push(view_stack *p, const camera_view *v)
{
    if (p->count == VIEWS_MAX) {
        memmove(&p->item[0], &p->item[1], (VIEWS_MAX - 1) * sizeof p->item[0]);
        p->count--;
    }
    p->item[p->count++] = *v;
}

void view_history_push(view_history *h, const camera_view *before, const char *gesture)
{
    const bool continues = gesture && h->gesture[0] && strcmp(gesture, h->gesture) == 0;
    snprintf(h->gesture, sizeof h->gesture, "%s", gesture ? gesture : "");
    if (!continues)
        push(&h->back, before);
    h->forward.count = 0;
}

bool view_history_go(view_history *h, bool forward, camera_view *now)
{
    view_stack *from = forward ? &h->forward : &h->back, *to = forward ? &h->back : &h->forward;
    if (from->count == 0)
        return false;
    push(to, now);
    *now = from->item[--from->count];
    h->gesture[0] = 0;
    return true;
}

void view_history_clear(view_history *h)
{
    h->back.count = h->forward.count = 0;
    h->gesture[0] = 0;
}
