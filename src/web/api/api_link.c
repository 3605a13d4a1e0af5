/* API: the scene as a link. See web/README.md. */
#include "web/api/api.h"
#include "report/json.h"
#include "scene/file/shared.h"

#include <stdlib.h>

status api_link(call *c)
{
    char *text = NULL, *code = NULL;
    scene *current = scene_document_take(c->l->scene_document, NULL);
    status result = current ? shared_scene_text(current, &text, &c->why) : out_of_memory(&c->why);
    THEN(result, shared_scene_code(text, &code, &c->why));
    c->refused = 409;
    if (result == STATUS_OK)
        api_reply_json(c, json_pack("{s:s, s:s}", "fragment", SHARED_FRAGMENT, "code", code));
    free(text);
    free(code);
    scene_destroy(current);
    return result;
}
