#include "scene/model/sheet.h"

#include "scene/model/integrators.h"

bool sheet_is_polariser(const material *m)
{
    return m->sheet != SHEET_NONE && m->sheet != SHEET_RETARDER;
}

bool sheet_has_axis(const material *m)
{
    return m->sheet == SHEET_POLARISER || m->sheet == SHEET_RETARDER;
}

bool sheet_retards(const material *m)
{
    return m->sheet == SHEET_RETARDER && (m->retardance_deg != 0.0 || m->birefringence != 0.0);
}

bool sheet_acts(const material *m, const render_settings *r)
{
    const bool light = !integrator_traits_of(r)->drawn && !integrator_traits_of(r)->layers;
    return light && (sheet_is_polariser(m) || (r->polarisation && sheet_retards(m)));
}

bool sheet_disperses(const material *m, const render_settings *r)
{
    return sheet_acts(m, r) && m->sheet == SHEET_RETARDER && m->birefringence != 0.0;
}

status sheet_check(const material *m, const char *label, diagnostic *why)
{
    const vec3 a = m->sheet_axis;
    if (!sheet_has_axis(m) || vec3_dot(a, a) > 0.0)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "set it to a vector in the solid's frame, such as 1,0,0",
                    "%.80s: the sheet_axis has no direction", label);
}
