/* A coin in a cup: solids named cup (opaque), coin (an upright cylinder on the cup's floor) and liquid
 * (experiments/scenes/coin.yaml). The eye is the camera's position; the cup's near rim hides the coin until the liquid
 * is deep enough. The least depth is found by bisection: does the ray from the eye that grazes the rim end on the coin?
 */
#include "realism/metrics.h"

#include "scene/model/medium.h"
#include "scene/model/scene.h"
#include <math.h>

/* The grazing ray passes this far above the rim, scene units. */
#define CLEARANCE 1e-12

typedef struct coin_view {
    int coin, liquid;
    vec3 eye, edge; /* the point of the rim's inner edge that is nearest to the eye */
    double floor;   /* height of the cup's floor */
    double tangent; /* of the line of sight over the edge, from the vertical */
    double drop;    /* of the coin's upper face below the rim */
    double across;  /* horizontal distance from the edge to the farthest point of that face in the line of sight */
    double n_around;
} coin_view;

static bool stands(const scene *s, const char *name, shape_kind kind)
{
    const int at = scene_find_solid(s, name);
    return at >= 0 && s->solids[at].visible && s->solids[at].shape.kind == kind;
}

bool coin_is_there(const scene *s)
{
    return stands(s, "cup", SHAPE_CUP) && stands(s, "coin", SHAPE_CYLINDER) && scene_find_solid(s, "liquid") >= 0;
}

static bool is_upright_and_round(const solid *one)
{
    const vec3 r = one->shape.rotation_deg;
    return r.x == 0.0 && r.y == 0.0 && r.z == 0.0 && one->shape.m == 1.0;
}

/* The plane of sight is vertical, through the eye and the cup's axis. */
static status coin_read(const scene *s, coin_view *out, diagnostic *why)
{
    const solid *cup = &s->solids[scene_find_solid(s, "cup")], *coin = &s->solids[scene_find_solid(s, "coin")];
    *out = (coin_view){.coin = scene_find_solid(s, "coin"), .liquid = scene_find_solid(s, "liquid")};
    const solid *liquid = &s->solids[out->liquid];
    const vec3 base = cup->shape.position;
    const index_law around = surrounding_index_law(&s->background);
    const double away = hypot(s->camera.position.x - base.x, s->camera.position.z - base.z),
                 inner = cup->shape.inner_radius, rim = base.y + cup->shape.height;
    if (!is_upright_and_round(cup) || !is_upright_and_round(coin) || !is_upright_and_round(liquid) ||
        liquid->shape.kind != SHAPE_CYLINDER)
        return diagnose(why, STATUS_BAD_INPUT, "set their rotation to 0 and m to 1; the liquid is a cylinder",
                        "'cup', 'coin' and 'liquid' are not upright and round");
    if (liquid->shape.capillary_length > 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "set its capillary_length to 0",
                        "'liquid' has a meniscus, and the curve needs a level one");
    if (cup->surface.transparency != 0.0 || coin->surface.transparency != 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "set the transparency of both to 0", "'cup' or 'coin' is not opaque");
    if (away <= inner || s->camera.position.y <= rim)
        return diagnose(why, STATUS_BAD_INPUT, "move the camera up, and away from the cup's axis",
                        "the eye does not look over the rim of 'cup' from outside");
    const vec3 sight = vec3_make((base.x - s->camera.position.x) / away, 0.0, (base.z - s->camera.position.z) / away);
    const vec3 off = vec3_sub(coin->shape.position, base);
    const double along = vec3_dot(off, sight), sideways = off.x * sight.z - off.z * sight.x;
    out->eye = s->camera.position;
    out->edge = vec3_make(base.x - inner * sight.x, rim, base.z - inner * sight.z);
    out->floor = base.y + cup->shape.floor;
    out->tangent = (away - inner) / (s->camera.position.y - rim);
    out->drop = rim - coin->shape.position.y - coin->shape.height;
    out->across = inner + along + sqrt(coin->shape.radius * coin->shape.radius - sideways * sideways);
    out->n_around = index_law_at(&around, s->render.lambda_nm);
    return isnan(out->across) ? diagnose(why, STATUS_BAD_INPUT, "move it towards the cup's axis",
                                         "'coin' is not in the plane of the eye and the cup's axis")
                              : STATUS_OK;
}

typedef struct filling {
    const metrics *m;
    const coin_view *at;
    scene *bare; /* cup, coin and liquid alone */
    status code;
    diagnostic *why;
} filling;

/* Whether the grazing ray meets the coin when the liquid's surface is at that height. */
static bool coin_is_seen(void *context, double surface)
{
    filling *f = context;
    trial t = {0};
    scene *filled = scene_clone(f->bare);
    bool seen = false;
    if (filled) {
        solid_shape *liquid = &filled->solids[f->at->liquid].shape;
        liquid->height = surface - liquid->position.y;
    }
    if (f->code == STATUS_OK)
        f->code = trial_start(&t, filled, f->m->level, f->why);
    if (f->code == STATUS_OK) {
        const vec3 clear = vec3_add(f->at->edge, vec3_make(0.0, CLEARANCE, 0.0));
        seen = trial_meets(&t, f->at->eye, vec3_sub(clear, f->at->eye), f->at->coin, false, &f->code, f->why);
    }
    trial_end(&t);
    return seen;
}

static scene *cup_alone(const scene *s, const coin_view *at)
{
    scene *bare = arrange_empty(s);
    if (bare) {
        material *liquid = &bare->solids[at->liquid].surface;
        bare->solids[at->liquid].visible = bare->solids[at->coin].visible = 1;
        bare->solids[scene_find_solid(bare, "cup")].visible = 1;
        liquid->medium = MEDIUM_IOR;
        liquid->transparency = 1.0;
    }
    return bare;
}

/* The indices with which the coin appears before the cup overflows. */
status coin_curve(const metrics *m, realism_points *out, diagnostic *why)
{
    coin_view at;
    TRY(coin_read(m->traced, &at, why));
    filling f = {m, &at, cup_alone(m->traced, &at), STATUS_OK, why};
    f.code = f.bare ? STATUS_OK : out_of_memory(why);
    for (int i = 10; i <= 80 && f.code == STATUS_OK; i++) {
        const double n = at.n_around * (1.0 + 0.01 * i), coin_top = at.edge.y - at.drop,
                     least = theory_least_depth(at.drop, at.across, at.tangent, n / at.n_around);
        if (!(least > 0.0 && least < at.drop))
            continue;
        f.bare->solids[at.liquid].surface.ior = n;
        const double surface = bisect(coin_is_seen, &f, coin_top, at.edge.y, false);
        curve_add(out, n, surface - at.floor, least + coin_top - at.floor);
    }
    scene_destroy(f.bare);
    return f.code;
}
