/* GET /api/machine; for web/api/api_studies.c, whose table it stands in. */
#ifndef CUVETTE_WEB_API_API_MACHINE_H
#define CUVETTE_WEB_API_API_MACHINE_H

#include "web/http/http.h"

http_handler api_machine;

#endif
