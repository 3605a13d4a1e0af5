/* GET /api/machine; for web/api_studies.c, whose table it stands in. */
#ifndef CUVETTE_WEB_API_MACHINE_H
#define CUVETTE_WEB_API_MACHINE_H

#include "web/http.h"

http_handler api_machine;

#endif
