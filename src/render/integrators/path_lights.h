/* Direct light of random paths: a shadow ray to a random point of each light with a size, or of one light chosen by its
 * estimated light (render/shade/light_choice.h). Functions of the tracer's gathered group; nothing fails. */
#pragma once

#include "render/shade/area_lights.h"

/* Adds the emission of the gathered group's surface, and enqueues shadow rays to lights. */
void path_sample_lights(tracer *t, int priority_index, int depth);
