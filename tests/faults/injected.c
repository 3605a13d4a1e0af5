#include "injected.h"

double injected[INJECT_KINDS];
