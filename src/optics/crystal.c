/* The boundary conditions of double refraction: tangential E and H of the incident wave and of up to four waves that
 * leave the interface are continuous, which is a linear system of four complex equations. */
#include "optics/crystal.h"

#include "optics/complex_pair.h"

typedef struct complex_vec3 {
    complex_pair x, y, z;
} complex_vec3;

/* A plane wave with the tangential part of the wave vector that all waves at the interface share: Maxwell's equations
 * with E exp(i k.r), H = k x E. */
typedef struct wave {
    complex_vec3 k, e, h;
    crystal_mode mode;
    bool travels; /* it carries energy away; else it is evanescent */
    double flux;  /* energy across the interface, positive into `to` */
    vec3 ray;     /* direction of energy */
} wave;

/* The interface: z is its normal into `to`, s and u are unit vectors along it; tangential is the part of the wave
 * vectors along it. */
typedef struct interface_frame {
    vec3 z, s, u, tangential;
} interface_frame;

static complex_vec3 of_real(vec3 a)
{
    return (complex_vec3){complex_of(a.x, 0.0), complex_of(a.y, 0.0), complex_of(a.z, 0.0)};
}

static complex_vec3 sum(complex_vec3 a, complex_vec3 b)
{
    return (complex_vec3){complex_add(a.x, b.x), complex_add(a.y, b.y), complex_add(a.z, b.z)};
}

static complex_vec3 scaled(vec3 a, complex_pair by)
{
    return (complex_vec3){complex_scale(by, a.x), complex_scale(by, a.y), complex_scale(by, a.z)};
}

static complex_vec3 times(complex_vec3 a, double by)
{
    return (complex_vec3){complex_scale(a.x, by), complex_scale(a.y, by), complex_scale(a.z, by)};
}

static complex_pair along(complex_vec3 a, vec3 b)
{
    return complex_add(complex_add(complex_scale(a.x, b.x), complex_scale(a.y, b.y)), complex_scale(a.z, b.z));
}

static complex_pair minor(complex_pair a, complex_pair b, complex_pair c, complex_pair d)
{
    return complex_sub(complex_multiply(a, b), complex_multiply(c, d));
}

static complex_vec3 cross(complex_vec3 a, complex_vec3 b)
{
    return (complex_vec3){minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
}

static double norm2(complex_vec3 a)
{
    return complex_norm2(a.x) + complex_norm2(a.y) + complex_norm2(a.z);
}

static double real_of_product(complex_pair a, complex_pair b) /* Re(a b*) */
{
    return a.re * b.re + a.im * b.im;
}

/* Re(E x H*), the flux of energy up to a factor that all waves share. */
static vec3 energy_of(const wave *w)
{
    const complex_vec3 e = w->e, h = w->h;
    return vec3_make(real_of_product(e.y, h.z) - real_of_product(e.z, h.y),
                     real_of_product(e.z, h.x) - real_of_product(e.x, h.z),
                     real_of_product(e.x, h.y) - real_of_product(e.y, h.x));
}

/* M of the extraordinary wave's ellipsoid k.M.k = 1: 1/n_e^2 across the axis, 1/n_o^2 along it. Born and Wolf, 15.3.2
 * (10). The energy travels along M k, the normal. */
static vec3 ellipsoid_times(const optical_medium *m, vec3 k)
{
    const double across = 1.0 / (m->n_e * m->n_e), more = 1.0 / (m->n_o * m->n_o) - across;
    return vec3_add(vec3_scale(k, across), vec3_scale(m->axis, more * vec3_dot(m->axis, k)));
}

vec3 crystal_wave_vector(const optical_medium *m, crystal_mode mode, vec3 d)
{
    if (!m->uniaxial || mode != MODE_EXTRAORDINARY)
        return vec3_scale(d, m->n_o);
    /* the inverse of M: k = M^-1 d / sqrt(d.M^-1.d) */
    const double across = m->n_e * m->n_e, more = m->n_o * m->n_o - across;
    const vec3 k = vec3_add(vec3_scale(d, across), vec3_scale(m->axis, more * vec3_dot(m->axis, d)));
    return vec3_scale(k, 1.0 / sqrt(vec3_dot(k, d)));
}

/* Sets the wave vector, whose part along z is (middle +- sqrt(disc)) over: the root that leaves the interface or, if
 * disc < 0, decays away from it. */
static void set_wave_vector(wave *w, const interface_frame *f, double middle, double disc, double over, bool ahead)
{
    const double sign = ahead ? 1.0 : -1.0;
    w->travels = disc > 0.0;
    const double root = sign * sqrt(magnitude(disc)) * over;
    const complex_pair part = w->travels ? complex_of(middle * over + root, 0.0) : complex_of(middle * over, root);
    w->k = sum(of_real(f->tangential), scaled(f->z, part));
}

static vec3 real_part(complex_vec3 a)
{
    return vec3_make(a.x.re, a.y.re, a.z.re);
}

/* A vector perpendicular to k and the axis; if k is along the axis, where both waves are the same, any one
 * perpendicular to k. */
static complex_vec3 across_axis(complex_vec3 k, const optical_medium *m, const interface_frame *f)
{
    const complex_vec3 w = cross(k, of_real(m->axis));
    return norm2(w) > 1e-24 * norm2(k) ? w : of_real(f->s);
}

/* Sets E and H of a wave in a crystal, whose k is known. The ordinary E is perpendicular to k and the axis. The
 * extraordinary D is perpendicular to k in the plane of k and the axis; E is the inverse of the dielectric tensor times
 * D. */
static void set_crystal_field(wave *w, const optical_medium *m, const interface_frame *f)
{
    w->e = across_axis(w->k, m, f);
    if (w->mode == MODE_EXTRAORDINARY) {
        const complex_vec3 D = cross(w->k, w->e);
        const double across = 1.0 / (m->n_o * m->n_o), more = 1.0 / (m->n_e * m->n_e) - across;
        w->e = sum(times(D, across), scaled(m->axis, complex_scale(along(D, m->axis), more)));
    }
    w->e = times(w->e, 1.0 / sqrt(norm2(w->e)));
    w->h = cross(w->k, w->e);
}

static void finish_wave(wave *w, const interface_frame *f, const optical_medium *m)
{
    w->flux = w->travels ? vec3_dot(energy_of(w), f->z) : 0.0;
    if (w->travels) {
        const vec3 k = real_part(w->k);
        w->ray = direction_tidy(vec3_normalize(w->mode == MODE_EXTRAORDINARY ? ellipsoid_times(m, k) : k));
    }
}

/* A wave in an isotropic medium, with its field in the plane of incidence or perpendicular to it. */
static wave isotropic_wave(const optical_medium *m, const interface_frame *f, bool ahead, bool in_plane)
{
    wave w = {.mode = MODE_ANY};
    set_wave_vector(&w, f, 0.0, m->n_o * m->n_o - vec3_dot(f->tangential, f->tangential), 1.0, ahead);
    w.e = in_plane ? times(cross(of_real(f->s), w.k), 1.0 / m->n_o) : of_real(f->s);
    w.h = cross(w.k, w.e);
    finish_wave(&w, f, m);
    return w;
}

static wave ordinary_wave(const optical_medium *m, const interface_frame *f, bool ahead)
{
    wave w = {.mode = MODE_ORDINARY};
    set_wave_vector(&w, f, 0.0, m->n_o * m->n_o - vec3_dot(f->tangential, f->tangential), 1.0, ahead);
    set_crystal_field(&w, m, f);
    finish_wave(&w, f, m);
    return w;
}

/* The wave vector's part c along z solves (z.M.z) c^2 + 2 (z.M.q) c + q.M.q - 1 = 0, with its tangential part q. */
static wave extraordinary_wave(const optical_medium *m, const interface_frame *f, bool ahead)
{
    wave w = {.mode = MODE_EXTRAORDINARY};
    const vec3 Mz = ellipsoid_times(m, f->z), Mq = ellipsoid_times(m, f->tangential);
    const double a = vec3_dot(f->z, Mz), b = vec3_dot(f->tangential, Mz), c = vec3_dot(f->tangential, Mq) - 1.0;
    set_wave_vector(&w, f, -b, b * b - a * c, 1.0 / a, ahead);
    set_crystal_field(&w, m, f);
    finish_wave(&w, f, m);
    return w;
}

/* The two waves of a medium that leave the interface, the ordinary last. */
static void waves_of(const optical_medium *m, const interface_frame *f, bool ahead, wave out[2])
{
    out[0] = m->uniaxial ? extraordinary_wave(m, f, ahead) : isotropic_wave(m, f, ahead, true);
    out[1] = m->uniaxial ? ordinary_wave(m, f, ahead) : isotropic_wave(m, f, ahead, false);
}

/* The incident waves: two in an isotropic medium, with fields along x and y of the ray's canonical frame; one in a
 * crystal, of the ray's mode. Returns their number. */
static int incident_waves(const crystal_incidence *in, const interface_frame *f, wave out[2])
{
    vec3 axes[2];
    const complex_vec3 k = of_real(crystal_wave_vector(&in->from, in->mode, in->d));
    const int count = in->from.uniaxial ? 1 : 2;
    polarisation_frame(in->d, &axes[0], &axes[1]);
    for (int i = 0; i < count; i++) {
        out[i] = (wave){.k = k, .e = of_real(axes[i]), .travels = true, .ray = in->d};
        out[i].h = cross(out[i].k, out[i].e);
        out[i].mode = in->mode == MODE_EXTRAORDINARY ? MODE_EXTRAORDINARY : MODE_ORDINARY;
        if (in->from.uniaxial)
            set_crystal_field(&out[i], &in->from, f);
        out[i].flux = vec3_dot(energy_of(&out[i]), f->z);
    }
    return count;
}

static interface_frame frame_of(const crystal_incidence *in)
{
    interface_frame f;
    f.z = vec3_scale(in->n, -1.0);
    const vec3 k = crystal_wave_vector(&in->from, in->mode, in->d);
    f.tangential = vec3_sub(k, vec3_scale(f.z, vec3_dot(k, f.z)));
    const vec3 s = vec3_cross(f.tangential, f.z);
    if (vec3_dot(s, s) > 1e-24)
        f.s = vec3_normalize(s);
    else
        polarisation_frame(f.z, &f.s, &f.u);
    f.u = vec3_cross(f.z, f.s);
    return f;
}

/* The tangential component in one of four equations: E along s and u, then H along s and u. */
static complex_pair tangential(const wave *w, const interface_frame *f, int equation)
{
    return along(equation < 2 ? w->e : w->h, equation % 2 ? f->u : f->s);
}

typedef struct linear_system {
    int size, sides;
    complex_pair row[4][6]; /* the matrix, then the right-hand sides, which become the solutions */
} linear_system;

static void swap_rows(linear_system *l, int a, int b)
{
    for (int k = 0; k < l->size + l->sides; k++) {
        const complex_pair swapped = l->row[a][k];
        l->row[a][k] = l->row[b][k], l->row[b][k] = swapped;
    }
}

/* Gauss-Jordan elimination with partial pivoting; false if the matrix is singular. */
static bool solve(linear_system *l)
{
    for (int c = 0; c < l->size; c++) {
        int best = c;
        for (int r = c + 1; r < l->size; r++)
            best = complex_norm2(l->row[r][c]) > complex_norm2(l->row[best][c]) ? r : best;
        swap_rows(l, best, c);
        const complex_pair pivot = l->row[c][c];
        if (!(complex_norm2(pivot) > 1e-40))
            return false;
        for (int k = c; k < l->size + l->sides; k++)
            l->row[c][k] = complex_divide(l->row[c][k], pivot);
        for (int r = 0; r < l->size; r++) {
            const complex_pair factor = l->row[r][c];
            for (int k = c; k < l->size + l->sides && r != c; k++)
                l->row[r][k] = complex_sub(l->row[r][k], complex_multiply(factor, l->row[c][k]));
        }
    }
    return true;
}

/* The amplitudes of the reflected waves, then of the transmitted ones, by incident wave. */
static bool find_amplitudes(const wave *incident, int sides, const wave *leaving, int count, const interface_frame *f,
                            complex_pair amplitude[4][2])
{
    linear_system l = {.size = count, .sides = sides};
    for (int r = 0; r < count; r++) {
        for (int c = 0; c < count; c++)
            l.row[r][c] = complex_scale(tangential(&leaving[c], f, r), c < 2 ? 1.0 : -1.0);
        for (int k = 0; k < sides; k++)
            l.row[r][count + k] = complex_scale(tangential(&incident[k], f, r), -1.0);
    }
    const bool found = solve(&l);
    for (int c = 0; c < count; c++)
        for (int k = 0; k < sides; k++)
            amplitude[c][k] = l.row[c][count + k];
    return found;
}

/* The analyser's row behind the interface, in an isotropic medium: conj(J) W J^T. W is the Hermitian matrix of the
 * incident row: light of coherency matrix C has the intensity tr(W C). For an incident mode of a crystal W has one
 * element. */
static stokes row_across(complex_pair J[2][2], int sides, stokes row)
{
    const complex_pair none = complex_of(0.0, 0.0);
    const complex_pair W[2][2] = {
        {complex_of(sides == 2 ? row.i + row.q : 2.0 * row.i, 0.0), complex_of(row.u, -row.v)},
        {complex_of(row.u, row.v), complex_of(row.i - row.q, 0.0)}};
    complex_pair out[2][2] = {{none, none}, {none, none}};
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            for (int c = 0; c < sides; c++)
                for (int d = 0; d < sides; d++)
                    out[a][b] =
                        complex_add(out[a][b], complex_multiply(complex_conj_multiply(J[a][c], W[c][d]), J[b][d]));
    const stokes s = {0.5 * (out[0][0].re + out[1][1].re), 0.5 * (out[0][0].re - out[1][1].re), out[1][0].re,
                      out[1][0].im};
    return s;
}

/* The weight of a crystal's mode behind the interface. From an isotropic medium: half of the intensity with which the
 * row sees the mode's light. From a mode of a crystal (sides 1): the row's weight times the fraction of the power. */
static double weight_across(const complex_pair j[2], int sides, stokes row)
{
    if (sides == 1)
        return row.i * complex_norm2(j[0]);
    const complex_pair between = complex_conj_multiply(j[0], j[1]);
    const double x = complex_norm2(j[0]), y = complex_norm2(j[1]);
    const stokes light = {x + y, x - y, 2.0 * between.re, 2.0 * between.im};
    return 0.5 * analyser_intensity(row, light);
}

/* Writes the rays in one medium, whose two waves have these amplitudes. Returns their number. */
static int add_rays(const optical_medium *m, const wave incident[2], int sides, const wave waves[2],
                    complex_pair amplitude[2][2], stokes row, crystal_ray *out)
{
    int count = 0;
    for (int i = 0; i < 2 && m->uniaxial; i++) {
        complex_pair j[2];
        for (int k = 0; k < sides; k++)
            j[k] = complex_scale(amplitude[i][k], sqrt(magnitude(waves[i].flux) / incident[k].flux));
        if (waves[i].travels)
            out[count++] = (crystal_ray){
                .d = waves[i].ray, .mode = waves[i].mode, .row = {.i = greater(weight_across(j, sides, row), 0.0)}};
    }
    if (m->uniaxial || !waves[0].travels)
        return count;
    vec3 axes[2];
    complex_pair J[2][2];
    polarisation_frame(waves[0].ray, &axes[0], &axes[1]);
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < sides; k++) {
            const complex_pair field = complex_add(complex_multiply(amplitude[0][k], along(waves[0].e, axes[a])),
                                                   complex_multiply(amplitude[1][k], along(waves[1].e, axes[a])));
            J[a][k] = complex_scale(field, sqrt(magnitude(waves[0].flux) / incident[k].flux));
        }
    out[0] = (crystal_ray){.d = waves[0].ray, .mode = MODE_ANY, .row = row_across(J, sides, row)};
    return 1;
}

int crystal_split(const crystal_incidence *in, stokes row, crystal_ray out[CRYSTAL_RAYS_MAX])
{
    const interface_frame f = frame_of(in);
    wave incident[2], leaving[4];
    complex_pair amplitude[4][2];
    const int sides = incident_waves(in, &f, incident);
    waves_of(&in->from, &f, false, leaving);
    if (!in->mirror)
        waves_of(&in->to, &f, true, leaving + 2);
    if (!(incident[0].flux > 0.0) || !find_amplitudes(incident, sides, leaving, in->mirror ? 2 : 4, &f, amplitude))
        return 0;
    int count = add_rays(&in->from, incident, sides, leaving, amplitude, row, out);
    for (int i = 0; i < count; i++)
        out[i].reflected = true;
    if (!in->mirror)
        count += add_rays(&in->to, incident, sides, leaving + 2, amplitude + 2, row, out + count);
    return count;
}
