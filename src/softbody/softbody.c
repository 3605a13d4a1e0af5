/* A soft body: its settings, its memory, and its quantities: energies, momenta, volume, masses. */
#include "softbody/softbody.h"
#include "softbody/softbody_private.h"
#include <stdlib.h>
#include <string.h>

/* --- settings --- */

static status refuse(diagnostic *why, const char *name, double value, const char *remedy)
{
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s is %g", name, value);
}

typedef struct bounded {
    const char *name;
    double value;
} bounded;

static status check_shape(const softbody_settings *s, diagnostic *why)
{
    const bounded above[] = {{"radius", s->radius}, {"mass_kg", s->mass_kg}, {"dt_s", s->dt_s}};
    const double lowest[] = {1e-6, SOFTBODY_MASS_MIN_KG, SOFTBODY_DT_MIN_S};
    for (size_t i = 0; i < sizeof above / sizeof above[0]; i++)
        if (!(above[i].value >= lowest[i] && above[i].value <= 1e6))
            return refuse(why, above[i].name, above[i].value,
                          i == 2 ? "use a number from 1e-9 to 1e6" : "use a number from 1e-6 to 1e6");
    const bounded least[] = {{"stiffness", s->stiffness}, {"bending", s->bending},   {"through", s->through},
                             {"damping", s->damping},     {"pressure", s->pressure}, {"friction", s->friction}};
    for (size_t i = 0; i < sizeof least / sizeof least[0]; i++)
        if (!(least[i].value >= 0.0 && least[i].value <= 1e9))
            return refuse(why, least[i].name, least[i].value, "give a number from 0 to 1e9");
    if (!(s->restitution >= 0.0 && s->restitution <= 1.0))
        return refuse(why, "restitution", s->restitution, "give a number from 0 to 1");
    if (!(fabs(s->ground_y) < 1e9))
        return refuse(why, "ground_y", s->ground_y, "give a number between -1e9 and 1e9");
    const vec3 all[] = {s->position, s->velocity, s->gravity};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (!(vec3_length(all[i]) < 1e9))
            return diagnose(why, STATUS_BAD_INPUT, "use a vector shorter than 1e9",
                            "position, velocity or gravity is too large");
    return STATUS_OK;
}

status softbody_check(const softbody_settings *s, diagnostic *why)
{
    if (s->level < 0 || s->level > SOFTBODY_LEVEL_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use a level from 0 to 7", "invalid slime level %ld", (long)s->level);
    if (s->threads < 1 || s->threads > 1024)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 1024", "invalid number of threads %ld", (long)s->threads);
    if (s->integrator < SOFTBODY_EULER || s->integrator > SOFTBODY_IMPLICIT)
        return diagnose(why, STATUS_BAD_INPUT, "use euler, verlet or implicit", "unknown integrator %ld",
                        (long)s->integrator);
    return check_shape(s, why);
}

/* --- creation --- */

static bool make_vectors(vectors *v, size_t stride)
{
    *v = (vectors){softbody_array(stride), softbody_array(stride), softbody_array(stride)};
    return v->x && v->y && v->z;
}

static void free_vectors(vectors v)
{
    free(v.x);
    free(v.y);
    free(v.z);
}

static bool make_solver(softbody *b)
{
    const size_t count = (size_t)b->net.slots * b->net.stride;
    b->stiff = (stiff_slots){softbody_array(count), softbody_array(count), softbody_array(count), softbody_array(count),
                             softbody_array(count)};
    vectors *const all[] = {&b->change, &b->residual, &b->direction, &b->image};
    bool complete = b->stiff.nx && b->stiff.ny && b->stiff.nz && b->stiff.across && b->stiff.along;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        complete &= make_vectors(all[i], b->net.stride);
    return complete;
}

static bool make_arrays(softbody *b)
{
    const size_t stride = b->net.stride, chunks = softbody_chunks(b);
    b->mass_kg = softbody_array(stride);
    b->inverse_mass = softbody_array(stride);
    b->sums = softbody_array(chunks);
    b->bad = calloc(chunks + 1, sizeof *b->bad);
    b->state = softbody_array(STATE * stride);
    bool complete = b->mass_kg && b->inverse_mass && b->sums && b->bad && b->state;
    complete &= make_vectors(&b->at, stride) && make_vectors(&b->velocity, stride) && make_vectors(&b->force, stride) &&
                make_vectors(&b->gradient, stride);
    if (b->set.integrator == SOFTBODY_VERLET)
        complete &= make_vectors(&b->acceleration, stride) && make_vectors(&b->guess, stride);
    return complete && (b->set.integrator != SOFTBODY_IMPLICIT || make_solver(b));
}

static bool copy_net(softbody *b, const softbody_net *net)
{
    b->spring_list = malloc((net->spring_count + 1) * sizeof *b->spring_list);
    b->faces = malloc((net->face_count + 1) * sizeof *b->faces);
    if (!b->spring_list || !b->faces)
        return false;
    if (net->spring_count > 0)
        memcpy(b->spring_list, net->springs, net->spring_count * sizeof *b->spring_list);
    if (net->face_count > 0)
        memcpy(b->faces, net->faces, net->face_count * sizeof *b->faces);
    b->spring_count = net->spring_count;
    b->face_count = net->face_count;
    return true;
}

static double extent_of(const softbody_net *net)
{
    vec3 low = net->position[0], high = low;
    for (size_t i = 1; i < net->mass_count; i++) {
        const vec3 p = net->position[i];
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    return fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
}

static void fill_masses(softbody *b, const softbody_net *net)
{
    for (size_t i = 0; i < net->mass_count; i++) {
        b->mass_kg[i] = net->mass_kg[i];
        b->inverse_mass[i] = 1.0 / net->mass_kg[i];
        vectors_put(b->at, i, net->position[i]);
        vectors_put(b->velocity, i, net->velocity ? net->velocity[i] : b->set.velocity);
    }
}

/* For x'' = -omega^2 x - gamma x', semi-implicit Euler is stable if omega^2 dt^2 + 2 gamma dt < 4 (Jury's criterion for
 * lambda^2 - (2 - gamma dt - omega^2 dt^2) lambda + 1 - gamma dt). Verlet, whose damping uses a predicted velocity,
 * allows half as much damping: without springs, trace 1 - 3/2 gamma dt and determinant -1/2 gamma dt limit it to gamma
 * dt < 1. */
static double stable_dt_of(softbody_integrator integrator, double omega2, double damping)
{
    const double gamma = integrator == SOFTBODY_VERLET ? 2.0 * damping : damping;
    if (omega2 > 0.0)
        return 4.0 / (gamma + sqrt(gamma * gamma + 4.0 * omega2));
    return gamma > 0.0 ? 2.0 / gamma : INFINITY;
}

/* Bounds omega^2 by Gershgorin's circles on the rows of the stiffness matrix over the mass: the diagonal element and
 * the sum of the others are both the sum of k at the vertex. */
static void find_stable_dt(softbody *b)
{
    double omega2 = 0.0, gamma = 0.0, pressed = 0.0;
    for (size_t i = 0; i < b->net.count; i++) {
        double k = 0.0, kd = 0.0;
        for (int slot = 0; slot < b->net.slots; slot++) {
            k += b->net.stiffness[(size_t)slot * b->net.stride + i];
            kd += b->net.damping[(size_t)slot * b->net.stride + i];
        }
        omega2 = fmax(omega2, 2.0 * k / b->mass_kg[i]);
        gamma = fmax(gamma, 2.0 * kd / b->mass_kg[i]);
        const vec3 g = vectors_at(b->gradient, i);
        pressed += vec3_dot(g, g) / (36.0 * b->mass_kg[i]);
    }
    if (b->volume_at_rest > 0.0)
        omega2 += b->set.pressure / b->volume_at_rest * pressed;
    b->stable_dt_s = stable_dt_of((softbody_integrator)b->set.integrator, omega2, gamma);
}

/* A step synchronises its threads several times, at tens of microseconds each: with less work than this, threads do not
 * pay. */
enum { CHUNKS_PER_THREAD = 8 };

static int useful_threads(const softbody *b)
{
    const int64_t most = (int64_t)(softbody_chunks(b) / CHUNKS_PER_THREAD);
    return most < 1 ? 1 : b->set.threads < most ? (int)b->set.threads : (int)most;
}

static status fill(softbody *b, const softbody_net *net, diagnostic *why)
{
    TRY(springs_build(&b->net, net, why));
    TRY(batches_build(&b->batches, &b->net, net, why));
    b->workers = thread_team_create(useful_threads(b));
    if (!make_arrays(b) || !copy_net(b, net) || !b->workers)
        return diagnose(why, STATUS_FAILURE, "use a lower level", "out of memory for a slime");
    fill_masses(b, net);
    b->size = extent_of(net);
    if (b->set.ground && softbody_measure(b).low < b->set.ground_y - 1e-9 * b->set.radius)
        return diagnose(why, STATUS_BAD_INPUT, "raise its position, or lower ground_y",
                        "the slime starts at height %g, below its floor at %g", softbody_measure(b).low,
                        b->set.ground_y);
    softbody_find_forces(b, &b->velocity);
    b->volume_at_rest = b->face_count > 0 ? softbody_volume_of_gradient(b) : 0.0;
    if (b->face_count > 0 && !(b->volume_at_rest > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "reverse the orientation of the faces", "the faces enclose no volume");
    find_stable_dt(b);
    return STATUS_OK;
}

static status check_net(const softbody_net *net, diagnostic *why)
{
    if (net->mass_count < 1 || net->mass_count > INT32_MAX / 64)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 33554431 masses", "a net cannot have %zu masses",
                        net->mass_count);
    for (size_t i = 0; i < net->mass_count; i++)
        if (!(net->mass_kg[i] > 0.0 && net->mass_kg[i] < INFINITY))
            return diagnose(why, STATUS_BAD_INPUT, "use masses above 0", "mass %zu has %g kg", i, net->mass_kg[i]);
    for (size_t i = 0; i < net->spring_count; i++) {
        const softbody_spring *s = &net->springs[i];
        if (s->end[0] >= net->mass_count || s->end[1] >= net->mass_count || s->end[0] == s->end[1])
            return diagnose(why, STATUS_BAD_INPUT, "connect two different masses of the net",
                            "spring %zu connects masses %lu and %lu of %zu", i, (unsigned long)s->end[0],
                            (unsigned long)s->end[1], net->mass_count);
        if (!(s->rest >= 0.0 && s->stiffness >= 0.0 && s->damping >= 0.0))
            return diagnose(why, STATUS_BAD_INPUT, "use values of at least 0",
                            "spring %zu has length %g, stiffness %g, damping %g", i, s->rest, s->stiffness, s->damping);
    }
    for (size_t i = 0; i < 3 * net->face_count; i++)
        if (net->faces[i / 3].corner[i % 3] >= net->mass_count)
            return diagnose(why, STATUS_BAD_INPUT, "number masses from 0 to one less than their number",
                            "a corner of face %zu is not a mass", i / 3);
    return STATUS_OK;
}

status softbody_create_net(const softbody_net *net, const softbody_settings *s, isa level, softbody **out,
                           diagnostic *why)
{
    static const softbody_kernels *const kernels[ISA_COUNT] = ISA_ARRAY(softbody_kernels);
    static const softbody_force_kernels *const force_kernels[ISA_COUNT] = ISA_ARRAY(softbody_force_kernels);
    *out = NULL;
    TRY(softbody_check(s, why));
    TRY(check_net(net, why));
    softbody *b = calloc(1, sizeof *b);
    if (!b)
        return out_of_memory(why);
    b->set = *s;
    b->surface_level = -1;
    b->kernels = kernels[level];
    b->force_kernels = force_kernels[level];
    status code = fill(b, net, why);
    if (code != STATUS_OK) {
        softbody_destroy(b);
        return code;
    }
    *out = b;
    return STATUS_OK;
}

status softbody_create(const softbody_settings *s, isa level, softbody **out, diagnostic *why)
{
    *out = NULL;
    toy_net toy = {0};
    TRY(softbody_check(s, why));
    TRY(toy_net_create(s, &toy, why));
    double *mass_kg = malloc(toy.mass_count * sizeof *mass_kg);
    for (size_t i = 0; mass_kg && i < toy.mass_count; i++)
        mass_kg[i] = s->mass_kg / (double)toy.mass_count;
    const softbody_net net = {.mass_count = toy.mass_count,
                              .spring_count = toy.spring_count,
                              .face_count = toy.face_count,
                              .position = toy.position,
                              .mass_kg = mass_kg,
                              .springs = toy.springs,
                              .faces = toy.faces};
    status code = mass_kg ? softbody_create_net(&net, s, level, out, why) : out_of_memory(why);
    if (code == STATUS_OK) {
        (*out)->mass_of = toy.mass_of;
        (*out)->surface_level = (int)s->level;
        toy.mass_of = NULL;
    }
    free(mass_kg);
    toy_net_release(&toy);
    return code;
}

void softbody_destroy(softbody *b)
{
    if (!b)
        return;
    const vectors all[] = {b->at,    b->velocity, b->force,    b->gradient,  b->acceleration,
                           b->guess, b->change,   b->residual, b->direction, b->image};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free_vectors(all[i]);
    double *const stiff[] = {b->stiff.nx, b->stiff.ny, b->stiff.nz, b->stiff.across, b->stiff.along};
    for (size_t i = 0; i < sizeof stiff / sizeof stiff[0]; i++)
        free(stiff[i]);
    for (int i = 0; i < SOFTBODY_HANDS_MAX; i++)
        free(b->hands[i].masses);
    thread_team_destroy(b->workers);
    springs_release(&b->net);
    batches_release(&b->batches);
    free(b->spring_list);
    free(b->faces);
    free(b->mass_kg);
    free(b->inverse_mass);
    free(b->sums);
    free(b->state);
    free(b->bad);
    free(b->plays);
    free(b->mass_of);
    free(b);
}

/* --- quantities ---
 *
 * Independent of the code of the steps, so that tests can compare the two. */

static double elastic_energy(const softbody *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < b->spring_count; i++) {
        const softbody_spring *s = &b->spring_list[i];
        const double extension =
            vec3_length(vec3_sub(vectors_at(b->at, s->end[1]), vectors_at(b->at, s->end[0]))) - s->rest;
        sum += 0.5 * s->stiffness * extension * extension;
    }
    return sum;
}

/* The sum of signed tetrahedra between the faces and a mass (divergence theorem). */
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

static void add_mass(const softbody *b, size_t i, softbody_quantities *out)
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

softbody_quantities softbody_measure(const softbody *b)
{
    softbody_quantities out = {.time_s = (double)b->steps * b->set.dt_s,
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
