/* One frame of cuvette-mpi on a simulated cluster: the loops of mpi/messenger.c and the hand-out of mpi/handout.c, as
 * they are, under SimGrid's smpirun. Rank 0 serves; every other rank stands for a rank of a cluster with one tracing
 * thread, the first of them on rank 0's host (see simulate.sh, which writes the host file). Prints a row of CSV.
 *
 * Arguments are NAME=VALUE: map, width, height, paths, tile, tiles_per_worker, pixel_bytes, message_ns, byte_ns,
 * scene_bytes, speed (sum of all hosts' speeds, processors of 1 Gf), label (the first cells of the row). */
#include "simulated_rank.h"
#include <math.h>
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct arguments {
    const char *map, *label;
    double width, height, paths, tile, tiles_per_worker, pixel_bytes, message_ns, byte_ns, scene_bytes, speed;
} arguments;

/* What rank 0 gathers; sums do not depend on the order of arrival. */
typedef struct gathered {
    const arguments *with;
    const frame_costs *frame;
    unsigned char *seen; /* by tile: how often it has arrived */
    char *film;          /* under mpirun: where tiles are copied to */
    double begun_s, begun_busy_s, complete_s, serving_s, idle_s;
    uint64_t check;
    int64_t arrived;
} gathered;

static const char *value_of(const char *argument, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(argument, name, length) == 0 && argument[length] == '=' ? argument + length + 1 : NULL;
}

static status read_arguments(int argc, char **argv, arguments *a, diagnostic *why)
{
    *a = (arguments){
        .map = "", .label = "", .paths = 1, .tile = 32, .tiles_per_worker = 4, .pixel_bytes = 24, .speed = 1};
    const struct {
        const char *name;
        double *value;
    } numbers[] = {{"width", &a->width},
                   {"height", &a->height},
                   {"paths", &a->paths},
                   {"tile", &a->tile},
                   {"tiles_per_worker", &a->tiles_per_worker},
                   {"pixel_bytes", &a->pixel_bytes},
                   {"message_ns", &a->message_ns},
                   {"byte_ns", &a->byte_ns},
                   {"speed", &a->speed},
                   {"scene_bytes", &a->scene_bytes}};
    for (int i = 1; i < argc; i++) {
        const char *text = value_of(argv[i], "map");
        bool known = text || value_of(argv[i], "label");
        a->map = text ? text : a->map;
        text = value_of(argv[i], "label");
        a->label = text ? text : a->label;
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0] && !known; k++)
            if ((text = value_of(argv[i], numbers[k].name))) {
                char *rest = NULL;
                *numbers[k].value = strtod(text, &rest);
                known = *text && !*rest && *numbers[k].value >= 0.0;
            }
        if (!known)
            return diagnose(why, STATUS_BAD_INPUT, "see the head of main.c", "argument %s is not known", argv[i]);
    }
    return a->width >= 1 && a->height >= 1
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, "set width and height", "the frame has no size");
}

static uint64_t mix(uint64_t v) /* SplitMix64 */
{
    v = (v ^ v >> 30) * 0xbf58476d1ce4e5b9u;
    v = (v ^ v >> 27) * 0x94d049bb133111ebu;
    return v ^ v >> 31;
}

/* A clock of rank 0's processor: of the cluster's while a tile is put, or of the process under mpirun. */
static double busy_s(void)
{
#ifdef SIMULATED
    return MPI_Wtime();
#else
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / 1e9;
#endif
}

static void put_tile(void *of, tile_message *tile)
{
    gathered *g = of;
    const int64_t number = tile->head.value;
    const size_t bytes = tile->bytes - sizeof tile->head;
    const double begun_s = busy_s();
    spend_ns(g->with->message_ns + g->with->byte_ns * (double)bytes);
    if (g->film)
        memcpy(g->film + (size_t)number * frame_tile_bytes(g->frame, 0), tile->values, bytes);
    g->serving_s += busy_s() - begun_s;
    g->seen[number]++;
    g->check += mix((uint64_t)number + 1);
    if (bytes != frame_tile_bytes(g->frame, number))
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    free(tile);
    if (++g->arrived < g->frame->tiles->tile_count)
        return;
    g->complete_s = MPI_Wtime() - g->begun_s;
#ifndef SIMULATED
    g->serving_s = busy_s() - g->begun_busy_s; /* messages too */
#endif
}

static void take_report(void *of, int rank, const rank_report *report, const worker_report *workers)
{
    gathered *g = of;
    (void)rank;
    (void)workers;
    g->idle_s += report->account.wall_s - report->account.cpu_s;
}

static void progress(void *of, double fraction_done)
{
    (void)of;
    (void)fraction_done;
}

static void print_row(const gathered *g, int ranks, const traffic *moved)
{
    double work_ns = 0.0, most_ns = 0.0;
    int64_t wrong = 0;
    for (int64_t tile = 0; tile < g->frame->tiles->tile_count; tile++) {
        const double ns = frame_tile_ns(g->frame, tile);
        work_ns += ns;
        most_ns = fmax(most_ns, ns);
        wrong += g->seen[tile] != 1;
    }
    const double ideal_s = work_ns / 1e9 / g->with->speed;
    printf("%s%d,%.0f,%.0f,%.0f,%d,%lld,%lld,%016llx,%.9g,%.9g,%.9g,%.9g,%.6f,%llu,%llu,%.9g,%.9g\n", g->with->label,
           ranks - 1, g->with->width, g->with->height, g->with->paths, g->frame->tiles->tile,
           (long long)g->frame->tiles->tile_count, (long long)wrong, (unsigned long long)g->check, work_ns / 1e9,
           most_ns / 1e9, ideal_s, g->complete_s, ideal_s / g->complete_s, (unsigned long long)moved->messages,
           (unsigned long long)moved->tile_bytes, g->serving_s, g->idle_s);
}

/* As mpi/scene_wire.c: the length of the one part, the part, and a length of 0. */
static void broadcast_scene(const arguments *with)
{
    int64_t length = (int64_t)with->scene_bytes;
    char *bytes = calloc((size_t)length + 1, 1);
    if (!bytes)
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    MPI_Bcast(&length, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
    MPI_Bcast(bytes, (int)length, MPI_BYTE, 0, MPI_COMM_WORLD);
    free(bytes);
    length = 0;
    MPI_Bcast(&length, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
}

/* As mpi/frame.c: the order to each rank, the scene by broadcast, then the messenger. */
static void lead(const arguments *with, const frame_costs *frame, int ranks)
{
    gathered g = {.with = with, .frame = frame};
    const frame_sink sink = {&g, put_tile, take_report, progress};
    const frame_order order = {.head.frame = 1};
    const size_t tile_bytes = frame_tile_bytes(frame, 0);
    handout *tiles = NULL;
    traffic moved = {0};
    simulated_rank nothing;
    const tracing own = simulated_tracing(&nothing, frame, 0);
    g.seen = calloc((size_t)frame->tiles->tile_count, 1);
#ifndef SIMULATED
    if ((g.film = malloc((size_t)frame->tiles->tile_count * tile_bytes)))
        memset(g.film, 1, (size_t)frame->tiles->tile_count * tile_bytes); /* its pages exist before the frame */
#endif
    (void)tile_bytes;
    if (!g.seen || handout_create(frame->tiles->tile_count, ranks, &tiles, NULL) != STATUS_OK)
        MPI_Abort(MPI_COMM_WORLD, STATUS_FAILURE);
    g.begun_s = MPI_Wtime();
    g.begun_busy_s = busy_s();
    for (int rank = 1; rank < ranks; rank++)
        MPI_Send(&order, sizeof order, MPI_BYTE, rank, TAG_FRAME, MPI_COMM_WORLD);
    broadcast_scene(with);
    messenger_serve(1, ranks, tiles, &own, &sink, &moved);
    print_row(&g, ranks, &moved);
    handout_destroy(tiles);
    free(g.film);
    free(g.seen);
}

static void follow(const arguments *with, const frame_costs *frame)
{
    frame_order order;
    traffic moved = {0};
    simulated_rank own;
    const tracing facing = simulated_tracing(&own, frame, 1);
    MPI_Recv(&order, sizeof order, MPI_BYTE, 0, TAG_FRAME, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    broadcast_scene(with);
    const double begun_s = MPI_Wtime();
    messenger_work(1, &facing, &moved);
    struct {
        rank_report rank;
        worker_report worker;
    } report = {
        .rank = {.head.frame = 1, .account = {.wall_s = MPI_Wtime() - begun_s, .cpu_s = own.busy_s}, .workers = 1}};
    MPI_Send(&report, sizeof report, MPI_BYTE, 0, TAG_REPORT, MPI_COMM_WORLD);
}

static status run(int argc, char **argv, int rank, int ranks, diagnostic *why)
{
    static cost_map map; /* of all simulated ranks, which are one process and take turns */
    arguments with;
    schedule tiles;
    TRY(read_arguments(argc, argv, &with, why));
    if (!map.before)
        TRY(cost_map_read(with.map, &map, why));
    /* The tiles that mpi/frame.c makes: its ranks are these without the serving one. */
    const render_settings settings = {.width = (int64_t)with.width,
                                      .height = (int64_t)with.height,
                                      .schedule = SCHEDULE_DYNAMIC,
                                      .tile = (int64_t)with.tile,
                                      .tiles_per_worker = (int64_t)with.tiles_per_worker,
                                      .threads = ranks - 1};
    schedule_start(&tiles, &settings);
    const frame_costs frame = {&map, &tiles, with.paths / map.paths, (size_t)with.pixel_bytes};
    if (rank == 0)
        lead(&with, &frame, ranks);
    else
        follow(&with, &frame);
    return STATUS_OK;
}

int main(int argc, char **argv)
{
    int rank = 0, ranks = 1;
    diagnostic why = {0};
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const status code = run(argc, argv, rank, ranks, &why);
    if (code != STATUS_OK && rank == 0)
        fprintf(stderr, "simulated: %s; %s\n", why.what, why.remedy);
    if (code != STATUS_OK)
        MPI_Abort(MPI_COMM_WORLD, code);
    MPI_Finalize();
    return 0;
}
