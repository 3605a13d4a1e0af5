/* The other ranks: wait for frames, trace the tiles that rank 0 gives them, until it ends. */
#pragma once

#include "base/status.h"

/* Returns when rank 0 ends. Errors of a frame are reported to rank 0; those that prevent any frame are returned. */
status follow(diagnostic *why);
