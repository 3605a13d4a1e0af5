#include "web/lab_private.h"
#include <stdlib.h>
struct live { int unused; };
const lab_routes slime_routes = {NULL, 0};
live *live_create(void (*wake)(void *context), void *context) { (void)wake; (void)context; return calloc(1, sizeof(live)); }
void live_destroy(live *l) { free(l); }
void live_stop(live *l) { (void)l; }
json_t *live_tell(live *l) { (void)l; return json_null(); }
bool live_is_on(live *l) { (void)l; return false; }
bool live_is_moving(live *l) { (void)l; return false; }
bool live_is_due(live *l) { (void)l; return false; }
live_preview live_preview_of(live *l) { (void)l; return LIVE_TRACED; }
status live_attach(live *l, scene *stage, diagnostic *why) { (void)l; (void)stage; (void)why; return STATUS_OK; }
void live_detach(live *l) { (void)l; }
status live_advance(live *l, double most_s, bool *told, diagnostic *why) { (void)l; (void)most_s; (void)told; (void)why; return STATUS_OK; }
bool live_take_moved(live *l) { (void)l; return false; }
