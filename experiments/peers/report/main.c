/* report - the rod scene by the report's algorithm (see report.h), timed and counted.
 *   report [-d DEPTH,...] [-t THREADS,...] [-r ROUNDS] [-s WIDTHxHEIGHT] [-f FOV_DEG] [-g INDEX] [-l INDEX] [-o
 * FILE.ppm] Every round renders each depth with each number of threads once, so that drift of the machine affects all
 * equally; a line a frame is printed with its times and exact counts of rays. CPU time is that of clock(), which adds
 * up all threads, as in the report. -f is the field of view over the shorter edge; -g and -l are the refractive indices
 * of glass and liquid; -o writes the last frame. Counting is always on; it costs a few additions a ray, compared with a
 * dozen heap allocations. */
#include "report.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { LIST_MAX = 64, DEPTH_MAX = 24, THREADS_MAX = 4096, ROUNDS_MAX = 10000, EDGE_MAX = 16384 };
static const char usage[] = "report [-d DEPTH,...] [-t THREADS,...] [-r ROUNDS] [-s WIDTHxHEIGHT] [-f FOV_DEG] "
                            "[-g INDEX] [-l INDEX] [-o FILE.ppm]";

typedef struct list {
    int count, value[LIST_MAX];
} list;
typedef struct order {
    list depths, threads;
    int rounds;
    setting of;
    const char *image;
} order;

/* Reads integers between separators; false if there is anything else. */
static bool read_list(const char *text, char separator, int low, int high, list *out)
{
    out->count = 0;
    for (;;) {
        char *end;
        errno = 0;
        const long value = strtol(text, &end, 10);
        if (end == text || errno || value < low || value > high || out->count == LIST_MAX)
            return false;
        out->value[out->count++] = (int)value;
        if (!*end)
            return true;
        if (*end != separator)
            return false;
        text = end + 1;
    }
}

static bool read_real(const char *text, float low, float high, float *out)
{
    char *end;
    *out = strtof(text, &end);
    return end != text && !*end && isfinite(*out) && *out >= low && *out <= high;
}

/* False for a value that is out of range, or for an unknown option. */
static bool read_option(int option, const char *text, order *o)
{
    list one;
    switch (option) {
    case 'd': return read_list(text, ',', 0, DEPTH_MAX, &o->depths);
    case 't': return read_list(text, ',', 1, THREADS_MAX, &o->threads);
    case 'f': return read_real(text, 1.0f, 170.0f, &o->of.fov_deg);
    case 'g': return read_real(text, 0.1f, 10.0f, &o->of.glass_index);
    case 'l': return read_real(text, 0.1f, 10.0f, &o->of.liquid_index);
    case 'o': o->image = text; return true;
    case 'r':
        if (!read_list(text, ',', 1, ROUNDS_MAX, &one) || one.count != 1)
            return false;
        o->rounds = one.value[0];
        return true;
    case 's':
        if (!read_list(text, 'x', 1, EDGE_MAX, &one) || one.count != 2)
            return false;
        o->of.width = one.value[0];
        o->of.height = one.value[1];
        return true;
    default: return false;
    }
}

static double wall_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The mean of all values, printed as a checksum to compare images. */
static double mean(const rgb *pixels, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += (double)pixels[i].r + (double)pixels[i].g + (double)pixels[i].b;
    return sum / (3.0 * (double)count);
}

static void print_frame(int round, const order *o, double cpu, double wall, const tally *n, const rgb *pixels)
{
    printf("%d\t%d\t%d\t%.6f\t%.6f\t%llu\t%llu\t%llu\t%llu\t%llu\t%llu\t%llu\t%llu\t%llu\t%llu\t%llu\t%.9f\n", round,
           o->of.depth, o->of.threads, cpu, wall, (unsigned long long)tally_rays(n), (unsigned long long)n->camera,
           (unsigned long long)n->secondary, (unsigned long long)n->shadow, (unsigned long long)n->sky,
           (unsigned long long)n->first_hits[SHAPE_GROUND], (unsigned long long)n->first_hits[SHAPE_VESSEL],
           (unsigned long long)n->first_hits[SHAPE_LIQUID], (unsigned long long)n->first_hits[SHAPE_ROD],
           (unsigned long long)n->busiest, (unsigned long long)n->busiest_sky,
           mean(pixels, (size_t)o->of.width * (size_t)o->of.height));
    fflush(stdout);
}

static void measure(int round, const order *o, rgb *pixels)
{
    room in;
    tally counted = {0};
    room_fill(&in, &o->of);
    const double wall = wall_s();
    const clock_t cpu = clock();
    room_frame(&in, &o->of, pixels, &counted);
    print_frame(round, o, (double)(clock() - cpu) / CLOCKS_PER_SEC, wall_s() - wall, &counted, pixels);
}

static unsigned char encoded(float value)
{
    return (unsigned char)(sqrtf(fminf(1.0f, fmaxf(0.0f, value))) * 255.0f + 0.5f);
}

/* Writes a binary PPM with gamma 2. */
static bool write_image(const order *o, const rgb *pixels)
{
    FILE *file = fopen(o->image, "wb");
    if (!file)
        return false;
    fprintf(file, "P6\n%d %d\n255\n", o->of.width, o->of.height);
    for (int i = 0; i < o->of.width * o->of.height; i++) {
        const unsigned char texel[3] = {encoded(pixels[i].r), encoded(pixels[i].g), encoded(pixels[i].b)};
        fwrite(texel, 1, sizeof texel, file);
    }
    const bool written = !ferror(file);
    return !fclose(file) && written;
}

int main(int count, char **words)
{
    order o = {.depths = {1, {4}},
               .threads = {1, {1}},
               .rounds = 1,
               .of = {.width = 800, .height = 600, .glass_index = 1.5f, .liquid_index = 1.33f, .fov_deg = 45.0f}};
    opterr = 0;
    for (int option; (option = getopt(count, words, "d:t:r:s:f:g:l:o:")) != -1;)
        if (!read_option(option, optarg, &o)) {
            if (option == '?')
                fprintf(stderr, "report: option '-%c' is unknown or has no value; usage: %s\n", optopt, usage);
            else
                fprintf(stderr, "report: '%s' is no value of -%c; usage: %s\n", optarg, option, usage);
            return 2;
        }
    if (optind < count) {
        fprintf(stderr, "report: unexpected argument '%s'; usage: %s\n", words[optind], usage);
        return 2;
    }
    rgb *pixels = allocate((size_t)o.of.width * (size_t)o.of.height * sizeof *pixels);
    printf("round\tdepth\tthreads\tcpu_s\twall_s\trays\tcamera\tsecondary\tshadow\tsky\t"
           "ground\tvessel\tliquid\trod\tbusiest\tbusiest_sky\tmean\n");
    for (int round = 0; round < o.rounds; round++)
        for (int d = 0; d < o.depths.count; d++)
            for (int t = 0; t < o.threads.count; t++) {
                o.of.depth = o.depths.value[d];
                o.of.threads = o.threads.value[t];
                measure(round, &o, pixels);
            }
    const bool kept = !o.image || write_image(&o, pixels);
    if (!kept)
        fprintf(stderr, "report: %s cannot be written (%s)\n", o.image, strerror(errno));
    free(pixels);
    return kept ? 0 : 1;
}
