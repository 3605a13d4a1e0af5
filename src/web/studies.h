/* Placeholder until the studies are there. */
#ifndef CUVETTE_WEB_STUDIES_H
#define CUVETTE_WEB_STUDIES_H
#include "web/lab_private.h"
status studies_create(lab *l, studies **out, diagnostic *why);
void studies_destroy(studies *s);
json_t *studies_tell(studies *s);
#endif
