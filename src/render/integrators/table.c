/* The table of integrators, from INTEGRATORS (scene/model/integrators.h). */
#include "render/tracer/integrator.h"

#define DECLARE(name, word, ...) extern const integrator integrator_of_##word;
INTEGRATORS(DECLARE)

const integrator *integrator_for(const render_settings *r)
{
#define ADDRESS(name, word, ...) &integrator_of_##word,
    static const integrator *const table[] = {INTEGRATORS(ADDRESS)};
    return table[r->integrator];
}
