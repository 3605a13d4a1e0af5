#include "web/lab_private.h"
const lab_routes edit_routes = {NULL, 0}, file_routes = {NULL, 0};
