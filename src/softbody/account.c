/* The account of a body: energies, momenta, volume; and access to its masses. Independent of the code of the steps, so
 * that it can check them. */
#include "softbody/softbody_private.h"

#include <string.h>

static double elastic_energy(const softbody *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < b->spring_count; i++) {
        const softbody_spring *s = &b->spring_list[i];
        const double longer =
            vec3_length(vec3_sub(vectors_at(b->at, s->end[1]), vectors_at(b->at, s->end[0]))) - s->rest;
        sum += 0.5 * s->stiffness * longer * longer;
    }
    return sum;
}

/* Signed tetrahedra between the faces and a mass (divergence theorem). */
static double volume_of(const softbody *b)
{
    const vec3 o = vectors_at(b->at, 0);
    double sum = 0.0;
    for (size_t i = 0; i < b->face_count; i++) {
        const uint32_t *corner = b->faces[i].corner;
        const vec3 p = vec3_sub(vectors_at(b->at, corner[0]), o), q = vec3_sub(vectors_at(b->at, corner[1]), o);
        sum += vec3_dot(p, vec3_cross(q, vec3_sub(vectors_at(b->at, corner[2]), o)));
    }
    return sum / 6.0;
}

static void add_mass(const softbody *b, size_t i, softbody_account *out)
{
    const double m = b->mass_kg[i];
    const vec3 p = vectors_at(b->at, i), v = vectors_at(b->velocity, i);
    out->kinetic += 0.5 * m * vec3_dot(v, v);
    out->gravity -= m * vec3_dot(b->set.gravity, p);
    out->momentum = vec3_add(out->momentum, vec3_scale(v, m));
    out->angular_momentum = vec3_add(out->angular_momentum, vec3_scale(vec3_cross(p, v), m));
    out->center = vec3_add(out->center, vec3_scale(p, m));
    out->speed_max = fmax(out->speed_max, vec3_length(v));
    out->low = fmin(out->low, p.y);
    out->high = fmax(out->high, p.y);
    out->held += b->inverse_mass[i] == 0.0;
}

softbody_account softbody_measure(const softbody *b)
{
    softbody_account out = {.time_s = (double)b->steps * b->set.dt_s,
                            .steps = b->steps,
                            .substeps = b->substeps,
                            .low = INFINITY,
                            .high = -INFINITY};
    double mass = 0.0;
    for (size_t i = 0; i < b->net.count; i++) {
        add_mass(b, i, &out);
        mass += b->mass_kg[i];
    }
    out.center = vec3_scale(out.center, 1.0 / mass);
    out.elastic = elastic_energy(b);
    out.volume_at_rest = b->volume_at_rest;
    out.volume = volume_of(b);
    const double missing = out.volume_at_rest - out.volume;
    out.compression = out.volume_at_rest > 0.0 ? 0.5 * b->set.pressure * missing * missing / out.volume_at_rest : 0.0;
    return out;
}

size_t softbody_mass_count(const softbody *b)
{
    return b->net.count;
}

size_t softbody_spring_count(const softbody *b)
{
    return b->spring_count;
}

void softbody_positions(const softbody *b, vec3 *out)
{
    for (size_t i = 0; i < b->net.count; i++)
        out[i] = vectors_at(b->at, i);
}

void softbody_velocities(const softbody *b, vec3 *out)
{
    for (size_t i = 0; i < b->net.count; i++)
        out[i] = vectors_at(b->velocity, i);
}

void softbody_place(softbody *b, const vec3 *positions, const vec3 *velocities)
{
    for (size_t i = 0; i < b->net.count; i++) {
        vectors_put(b->at, i, positions[i]);
        vectors_put(b->velocity, i, velocities[i]);
    }
    b->has_acceleration = false;
    memset(b->bad, 0, softbody_chunks(b) * sizeof *b->bad);
}
