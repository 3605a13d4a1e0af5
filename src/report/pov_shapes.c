/* Colours, images, shapes, triangles and texture coordinates in POV-Ray's scene language. Its world is left-handed
 * like ours, and a number is written with the fewest digits that read back the same. */
#include "base/number.h"
#include "geometry/shapes/lens_profile.h"
#include "geometry/shapes/shape.h"
#include "report/scene_export.h"

#include <math.h>
#include <string.h>
#include <strings.h>

void pov_number(FILE *out, double value)
{
    char text[NUMBER_TEXT_MAX];
    fputs(number_format(value + 0.0, text), out); /* no -0 */
}

void pov_vector(FILE *out, vec3 v)
{
    const double c[3] = {v.x, v.y, v.z};
    for (int k = 0; k < 3; k++) {
        fputs(k ? ", " : "<", out);
        pov_number(out, c[k]);
    }
    putc('>', out);
}

void pov_color(const pov *v, vec3 c)
{
    fputs("rgb ", v->out);
    pov_vector(v->out, c);
}

void pov_light(const pov *v, vec3 c)
{
    pov_color(v, vec3_scale(c, v->gain));
}

void pov_named(const pov *v, const char *name, double value)
{
    fprintf(v->out, " %s ", name);
    pov_number(v->out, value);
}

/* Writes a template in which each # is the next number. */
static void put(FILE *out, const char *form, const double *numbers)
{
    for (; *form; form++)
        if (*form == '#')
            pov_number(out, *numbers++);
        else
            putc(*form, out);
}
#define PUT(out, form, ...) put(out, form, (const double[]){__VA_ARGS__})

void pov_placement_write(const solid_shape *shape, FILE *out)
{
    const vec3 r = shape->rotation_deg, p = shape->position;
    const mat3 m = rotation_from_deg(r);
    const vec3 *row = m.row;
    if (shape_is_scaled(shape))
        PUT(out, " scale <#, #, #>", shape->scale.x, shape->scale.y, shape->scale.z);
    if (r.x != 0.0 || r.y != 0.0 || r.z != 0.0) /* POV-Ray multiplies a row by the matrix */
        PUT(out, " matrix <#, #, #, #, #, #, #, #, #, #, #, #>", row[0].x, row[1].x, row[2].x, row[0].y, row[1].y,
            row[2].y, row[0].z, row[1].z, row[2].z, p.x, p.y, p.z);
    else if (p.x != 0.0 || p.y != 0.0 || p.z != 0.0)
        PUT(out, " translate <#, #, #>", p.x, p.y, p.z);
}

/* --- images --- */

/* POV-Ray's word for the format of an image file, or NULL. */
const char *pov_image_word(const char *path)
{
    static const char *const words[][2] = {{".png", "png"}, {".jpg", "jpeg"}, {".jpeg", "jpeg"}, {".bmp", "sys"},
                                           {".exr", "exr"}, {".hdr", "hdr"},  {".tga", "tga"}};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof words / sizeof *words; i++)
        if (strcasecmp(dot, words[i][0]) == 0)
            return words[i][1];
    return NULL;
}

/* A pigment: the image's colour at u and v, functions of x, y, z, times a factor; `most`: its largest value. */
void pov_image_pigment(const pov *v, const char *name, const char *at_u, const char *at_v, vec3 factor, double most)
{
    static const char *const channels[] = {"red", "green", "blue"};
    const double f[3] = {factor.x, factor.y, factor.z};
    fputs("average pigment_map {", v->out);
    for (int c = 0; c < 3; c++) {
        fprintf(v->out, "\n      [1 function { min(%s_%s(%s, %s, 0)/", name, channels[c], at_u, at_v);
        pov_number(v->out, most);
        fputs(", 1) } color_map { [0 rgb 0] [1 ", v->out);
        const double full = 3.0 * most * f[c];
        pov_color(v, vec3_make(c == 0 ? full : 0.0, c == 1 ? full : 0.0, c == 2 ? full : 0.0));
        fputs("] }]", v->out);
    }
    fputs("\n    }", v->out);
}

/* --- shapes; e: how far the surface moves inwards --- */

static void put_plane(const solid_shape *s, double e, FILE *out)
{
    (void)s;
    PUT(out, "plane { y, # }", -e);
}

static void put_sphere(const solid_shape *s, double e, FILE *out)
{
    PUT(out, "sphere { 0, # }", s->radius - e);
}

static void put_box(const solid_shape *s, double e, FILE *out)
{
    const vec3 h = vec3_sub(vec3_scale(s->size, 0.5), vec3_make(e, e, e));
    PUT(out, "box { <#, #, #>, <#, #, #> }", -h.x, -h.y, -h.z, h.x, h.y, h.z);
}

static void put_torus(const solid_shape *s, double e, FILE *out)
{
    PUT(out, "torus { #, # sturm }", s->radius, s->tube_radius - e);
}

/* The radius across which an ellipse's wall moves by at least e. */
static double narrowed(double radius, double m, double e)
{
    return radius - e * fmax(m, 1.0);
}

static void put_ellipse(double m, FILE *out)
{
    if (m != 1.0)
        PUT(out, " scale <1, 1, #>", 1.0 / m);
}

static void put_cylinder(const solid_shape *s, double e, FILE *out)
{
    PUT(out, "cylinder { y*#, y*#, #", e, s->height - e, narrowed(s->radius, s->m, e));
    put_ellipse(s->m, out);
    fputs(" }", out);
}

/* The hollow goes on above the rim, and of a tube below it, so that no two surfaces coincide there. */
static void put_cup(const solid_shape *s, double e, FILE *out)
{
    const double from = s->floor > 0.0 ? s->floor - e : -s->height;
    PUT(out, "difference { cylinder { y*#, y*#, # } cylinder { y*#, y*#, # }", e, s->height - e,
        narrowed(s->radius, s->m, e), from, 2.0 * s->height, s->inner_radius + e * fmax(s->m, 1.0));
    put_ellipse(s->m, out);
    fputs(" }", out);
}

static void put_cone(const solid_shape *s, double e, FILE *out)
{
    const double slope = (s->top_radius - s->radius) / s->height, aside = e * sqrt(1.0 + slope * slope);
    const double low = s->radius + slope * e - aside, high = s->top_radius - slope * e - aside;
    const double tip = high < 0.0 && slope < 0.0 ? -low / slope : s->height - 2.0 * e;
    PUT(out, "cone { y*#, #, y*#, # }", e, low, e + tip, fmax(high, 0.0));
}

static void put_prism(const solid_shape *s, double e, FILE *out)
{
    const double angle = M_PI / (double)s->sides, radius = s->radius - e / cos(angle);
    PUT(out, "prism { linear_sweep linear_spline #, #, #", e, s->height - e, (double)s->sides + 1.0);
    for (int64_t k = 0; k <= s->sides; k++) {
        const double turn = 2.0 * angle * (double)(k % s->sides);
        PUT(out, ", <#, #>", radius * sin(turn), -radius * cos(turn));
    }
    fputs(" }", out);
}

/* Whether the side is a conic up to the rim, without a bevel, with all of the lens on one side of an ellipsoid's
 * centre, or on one sheet of a hyperboloid. */
static bool is_conic(const solid_shape *s, int k)
{
    const lens_profile side = lens_profile_of(s, k);
    const double far = fmax(fabs(lens_highest_of(s, 1) - side.vertex), fabs(lens_lowest_of(s, 0) - side.vertex));
    return !side.aspheric && !lens_has_ring(&side) && lens_chamfer(s, k) == 0.0 &&
           (lens_is_flat(&side) || far * fabs(side.e.curvature * (1.0 + side.conic)) < 1.0);
}

/* The quadric c (x^2 + z^2 + (1 + k) u^2) - 2 u = 0 (geometry/primitives/lens_side.h), whose negative side is the
 * convex one; a sphere moves about its centre. */
static void put_side(const solid_shape *s, int k, double e, FILE *out)
{
    const lens_profile side = lens_profile_of(s, k);
    const double inwards = k == 0 ? 1.0 : -1.0, vertex = side.vertex + inwards * e;
    const double up = side.concave ? -inwards : inwards, c = fabs(side.e.curvature);
    if (lens_is_flat(&side)) {
        PUT(out, " plane { y*#, # }", -inwards, -inwards * vertex);
        return;
    }
    if (side.conic == 0.0)
        PUT(out, " sphere { y*#, #", side.vertex + up / c, 1.0 / c + (side.concave ? e : -e));
    else
        PUT(out, " quadric { <#, #, #>, <0, 0, 0>, <0, #, 0>, 0 translate y*#", c, (1.0 + side.conic) * c, c, -2.0 * up,
            vertex);
    fputs(side.concave ? " inverse }" : " }", out);
}

/* The rim's cylinder ends beyond the vertex of a convex side, and at the edge of a concave one. */
static void put_lens(const solid_shape *s, double e, FILE *out)
{
    double end[2];
    for (int k = 0; k < 2; k++) {
        const lens_profile side = lens_profile_of(s, k);
        end[k] = side.concave ? lens_edge(s, k) : side.vertex + (k == 0 ? -1.0 : 1.0) * (s->thickness + lens_rim(s));
    }
    PUT(out, "intersection { cylinder { y*#, y*#, # }", end[0], end[1], lens_rim(s) - e);
    put_side(s, 0, e, out);
    put_side(s, 1, e, out);
    fputs(" }", out);
}

static bool is_level(const solid_shape *s)
{
    return s->capillary_length == 0.0;
}

static bool is_of_conics(const solid_shape *s)
{
    return is_conic(s, 0) && is_conic(s, 1);
}

/* A shape that is not here, or not as `applies` wants it, is written as triangles. */
static const struct {
    const shape_rule *rule;
    void (*write)(const solid_shape *s, double e, FILE *out);
    bool (*applies)(const solid_shape *s);
} forms[] = {{&shape_plane, put_plane, NULL},
             {&shape_sphere, put_sphere, NULL},
             {&shape_box, put_box, NULL},
             {&shape_torus, put_torus, NULL},
             {&shape_cup, put_cup, NULL},
             {&shape_cone, put_cone, NULL},
             {&shape_cylinder, put_cylinder, is_level},
             {&shape_prism, put_prism, NULL},
             {&shape_lens, put_lens, is_of_conics}};
enum { FORMS = sizeof forms / sizeof *forms };

bool pov_shape_can_inset(const solid_shape *shape)
{
    for (size_t i = 0; i < FORMS; i++)
        if (forms[i].rule == shape_of(shape))
            return !forms[i].applies || forms[i].applies(shape);
    return false;
}

status pov_shape_write(const solid_shape *shape, double inset, FILE *out, bool *exact, diagnostic *why)
{
    const shape_rule *rule = shape_of(shape);
    const vec3 k = shape->scale; /* applied with the placement; it multiplies the inset, which is an upper limit */
    const double most = shape_is_scaled(shape) ? fmax(fabs(k.x), fmax(fabs(k.y), fabs(k.z))) : 1.0;
    for (size_t i = 0; i < FORMS; i++)
        if (forms[i].rule == rule && (!forms[i].applies || forms[i].applies(shape))) {
            forms[i].write(shape, inset / most, out);
            return STATUS_OK;
        }
    mesh *m = NULL;
    *exact = false;
    TRY(rule->tessellation(shape, 0, &m, why));
    pov_mesh_write(m, true, "", false, false, out);
    mesh_release(m);
    return STATUS_OK;
}

/* --- triangles --- */

enum { IN_A_LINE = 4 };

static const char *separator(size_t i)
{
    return i % IN_A_LINE ? ", " : ",\n    ";
}

void pov_mesh_write(const mesh *m, bool smooth, const char *head, bool by_slot, bool by_vertex, FILE *out)
{
    const bool normals = smooth && m->normals;
    fprintf(out, "mesh2 {\n  vertex_vectors { %zu", m->vertex_count);
    for (size_t v = 0; v < m->vertex_count; v++) {
        fputs(separator(v), out);
        pov_vector(out, m->vertices[v]);
    }
    if (normals)
        fprintf(out, " }\n  normal_vectors { %zu", m->vertex_count);
    for (size_t v = 0; normals && v < m->vertex_count; v++) {
        fputs(separator(v), out);
        pov_vector(out, m->normals[v]);
    }
    if (m->uvs)
        fprintf(out, " }\n  uv_vectors { %zu", m->vertex_count);
    for (size_t v = 0; m->uvs && v < m->vertex_count; v++) {
        fputs(separator(v), out);
        PUT(out, "<#, #>", m->uvs[v].u, m->uvs[v].v);
    }
    fprintf(out, " }\n%s  face_indices { %zu", head, m->triangle_count);
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *c = m->triangles[t].corner;
        fprintf(out, "%s<%lu, %lu, %lu>", separator(t), (unsigned long)c[0], (unsigned long)c[1], (unsigned long)c[2]);
        if (by_vertex)
            fprintf(out, ", %lu, %lu, %lu", (unsigned long)c[0], (unsigned long)c[1], (unsigned long)c[2]);
        else if (by_slot)
            fprintf(out, ", %d", m->slots ? m->slots[t] : 0);
    }
    fputs(" }\n", out);
    if (m->closed)
        fputs("  inside_vector <0.31, 0.87, 0.23>\n", out);
    putc('}', out);
}

/* --- texture coordinates, as the mapping functions of geometry/primitives --- */

#define TURN "(0.5 + atan2(x, -z)/(2*pi))" /* once around the axis, the middle in front */

static bool map_plane(const solid_shape *s, double size, FILE *u, FILE *v)
{
    (void)s;
    PUT(u, "x/#", size > 0.0 ? size : 1.0);
    PUT(v, "z/#", size > 0.0 ? size : 1.0);
    return true;
}

static bool map_sphere(const solid_shape *s, double size, FILE *u, FILE *v)
{
    PUT(u, TURN "*#", size > 0.0 ? 2.0 * M_PI * s->radius / size : 1.0);
    PUT(v, "(0.5 + atan2(y, sqrt(x*x + z*z))/pi)*#", size > 0.0 ? M_PI * s->radius / size : 1.0);
    return true;
}

/* The face is that of the largest coordinate, in halves of the edges. */
static void map_faces(vec3 h, const char *of_x, const char *of_y, const char *of_z, FILE *out)
{
    PUT(out, "select(min(abs(x)/# - abs(y)/#, abs(x)/# - abs(z)/#), select(abs(y)/# - abs(z)/#, ", h.x, h.y, h.x, h.z,
        h.y, h.z);
    fprintf(out, "%s, %s, %s), %s, %s)", of_z, of_y, of_y, of_x, of_x);
}

static bool map_box(const solid_shape *s, double size, FILE *u, FILE *v)
{
    const vec3 h = vec3_scale(s->size, 0.5);
    const double edge[3] = {s->size.x, s->size.y, s->size.z}, half[3] = {h.x, h.y, h.z};
    char along[3][2][96]; /* from the lower corner, and from the upper one, in images */
    for (int k = 0; k < 3; k++) {
        char from[NUMBER_TEXT_MAX], over[NUMBER_TEXT_MAX];
        number_format(half[k], from);
        number_format(size > 0.0 ? size : edge[k], over);
        snprintf(along[k][0], sizeof along[k][0], "(%c + %s)/%s", "xyz"[k], from, over);
        snprintf(along[k][1], sizeof along[k][1], "(%s - %c)/%s", from, "xyz"[k], over);
    }
    char of_x[240], of_y[240], of_z[240];
    snprintf(of_x, sizeof of_x, "select(x, %s, %s)", along[2][1], along[2][0]);
    snprintf(of_y, sizeof of_y, "select(y, %s, %s)", along[2][1], along[2][0]);
    snprintf(of_z, sizeof of_z, "select(z, %s, %s)", along[0][0], along[0][1]);
    map_faces(h, of_x, along[0][0], of_z, u);
    map_faces(h, along[1][0], of_y, along[1][0], v);
    return true;
}

/* A face at the bottom and one at the top, seen from outside, of the half widths low and high, and a side between. */
static void map_caps(double height, double size, double low, double high, const char *side_u, const char *side_v,
                     FILE *u, FILE *v)
{
    const double near = 1e-6 * height, wide_low = size > 0.0 ? size : 2.0 * low,
                 wide_high = size > 0.0 ? size : fmax(2.0 * high, 1e-300);
    PUT(u, "select(y - #, (x + #)/#, select(# - y, (x + #)/#, ", near, low, wide_low, height - near, high, wide_high);
    PUT(v, "select(y - #, (# - z)/#, select(# - y, (z + #)/#, ", near, low, wide_low, height - near, high, wide_high);
    fprintf(u, "%s))", side_u);
    fprintf(v, "%s))", side_v);
}

/* The same with a side that is round. */
static void map_round(double height, double size, double low, double high, double around, double along, FILE *u,
                      FILE *v)
{
    char number[NUMBER_TEXT_MAX], side_u[96], side_v[64];
    snprintf(side_u, sizeof side_u, TURN "*%s", number_format(around, number));
    snprintf(side_v, sizeof side_v, "y*%s", number_format(along, number));
    map_caps(height, size, low, high, side_u, side_v, u, v);
}

static bool map_cylinder(const solid_shape *s, double size, FILE *u, FILE *v)
{
    const double r = s->radius;
    if (!is_level(s))
        return false;
    map_round(s->height, size, r, r, size > 0.0 ? 2.0 * M_PI * r / size : 1.0, 1.0 / (size > 0.0 ? size : s->height), u,
              v);
    return true;
}

static bool map_cone(const solid_shape *s, double size, FILE *u, FILE *v)
{
    const double slope = (s->top_radius - s->radius) / s->height, slant = sqrt(1.0 + slope * slope),
                 r = fmax(s->radius, s->top_radius);
    map_round(s->height, size, s->radius, s->top_radius, size > 0.0 ? 2.0 * M_PI * r / size : 1.0,
              size > 0.0 ? slant / size : 1.0 / s->height, u, v);
    return true;
}

/* The side whose middle is at the angle (2 k + 1) pi / n from -z towards x. */
static bool map_prism(const solid_shape *s, double size, FILE *u, FILE *v)
{
    const double r = s->radius, half = r * sin(M_PI / (double)s->sides);
    char side_u[400], side_v[64], number[NUMBER_TEXT_MAX], wide[NUMBER_TEXT_MAX], middle[96];
    const int n = (int)s->sides;
    snprintf(middle, sizeof middle, "(2*floor(atan2(x, -z)*%d/(2*pi)) + 1)*pi/%d", n, n);
    snprintf(side_u, sizeof side_u, "(z*sin(%s) + x*cos(%s) + %s)/%s", middle, middle, number_format(half, number),
             number_format(size > 0.0 ? size : 2.0 * half, wide));
    snprintf(side_v, sizeof side_v, "y/%s", number_format(size > 0.0 ? size : s->height, number));
    map_caps(s->height, size, r, r, side_u, side_v, u, v);
    return true;
}

/* The height of a side less y, as a function. */
static void put_sag(const solid_shape *s, int k, FILE *out)
{
    const lens_profile side = lens_profile_of(s, k);
    const double c = side.e.curvature;
    PUT(out, "# + #*(x*x + z*z)/(1 + sqrt(max(0, 1 - #*(x*x + z*z)))) - y", side.vertex, c, (1.0 + side.conic) * c * c);
}

/* The rim is where the distance from the axis is its radius, up to a millionth. */
static bool map_lens(const solid_shape *s, double size, FILE *u, FILE *v)
{
    const double r = lens_rim(s), low = lens_edge(s, 0), near = 1e-6 * r, wide = size > 0.0 ? size : 2.0 * r;
    if (!is_of_conics(s))
        return false;
    PUT(u, "select(sqrt(x*x + z*z) - #, (x + #)/#, " TURN "*#)", r - near, r, wide,
        size > 0.0 ? 2.0 * M_PI * r / size : 1.0);
    PUT(v, "select(sqrt(x*x + z*z) - #, select(abs(", r - near);
    put_sag(s, 0, v);
    PUT(v, ") - #, (# - z)/#, (z + #)/#), (y - #)/#)", near, r, wide, r, wide, low,
        size > 0.0 ? size : fmax(lens_edge(s, 1) - low, 1e-300));
    return true;
}

static bool map_torus(const solid_shape *s, double size, FILE *u, FILE *v)
{
    PUT(u, TURN "*#", size > 0.0 ? 2.0 * M_PI * s->radius / size : 1.0);
    PUT(v, "(0.5 + atan2(y, sqrt(x*x + z*z) - #)/(2*pi))*#", s->radius,
        size > 0.0 ? 2.0 * M_PI * s->tube_radius / size : 1.0);
    return true;
}

bool pov_mapping(const solid_shape *shape, double size, FILE *u, FILE *v)
{
    static const struct {
        const shape_rule *rule;
        bool (*map)(const solid_shape *s, double size, FILE *u, FILE *v);
    } maps[] = {{&shape_plane, map_plane},       {&shape_sphere, map_sphere}, {&shape_box, map_box},
                {&shape_cylinder, map_cylinder}, {&shape_cone, map_cone},     {&shape_torus, map_torus},
                {&shape_prism, map_prism},       {&shape_lens, map_lens}};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (maps[i].rule == shape_of(shape))
            return maps[i].map(shape, size, u, v);
    return false;
}
