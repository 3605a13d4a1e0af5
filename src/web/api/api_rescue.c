/* API: scenes of laboratories that ended without saving. See web/README.md. */
#include "web/api/api.h"
#include "web/session/rescue.h"

#include <string.h>

status api_rescue(call *c)
{
    const char *action = NULL, *id = NULL;
    uint64_t generation = 0;
    if (!api_take_text(c, "action", true, &action) || !api_take_text(c, "id", true, &id))
        return STATUS_BAD_INPUT;
    const bool opens = strcmp(action, "open") == 0;
    if (!opens && strcmp(action, "discard") != 0)
        return api_refuse(c, 400, "'action' is neither open nor discard", "give open or discard");
    if (opens)
        return api_changed(c, rescue_open(c->l->rescue, id, &generation, &c->why), generation);
    TRY(rescue_discard(c->l->rescue, id, &c->why));
    return api_state(c);
}
