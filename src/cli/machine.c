#include "cli/cli.h"
#include "cli/json.h"
#include "cli/options.h"
#include "base/isa.h"
#include "measure/clock.h"
#include "measure/topology.h"
#include "measure/usage.h"
#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/utsname.h>

#define LOAD_SAMPLE_S 0.5

enum { KEY_JSON = 0x100 };

static const struct argp_option options[] = {
    {"json", KEY_JSON, NULL, 0, "print JSON", 0},
    {0},
};

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    bool *as_json = input->request;
    if (key == KEY_JSON) {
        *as_json = true;
        return 0;
    }
    if (key != ARGP_KEY_ARG)
        return ARGP_ERR_UNKNOWN;
    diagnose(input->why, STATUS_BAD_INPUT, "leave it out", "'%.128s' is one argument too many", value);
    diagnostic_locate(input->why, "machine", 0, 0);
    return EINVAL;
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .doc = "Print what this machine is: its processors and caches, the step and the cost of its clocks, the vector "
           "instructions in use, and what could disturb a measurement now.",
};

typedef struct account {
    topology *machine;
    isa best, chosen;
    clock_quality wall, cpu;
    struct utsname kernel;
    bool has_hardware_counters;
    json_t *disturbances;
} account;

static void add_disturbance(void *context, const char *text)
{
    json_array_append_new(context, json_of_text(text));
}

static bool counts_cycles(void)
{
    hardware_counter *counter = hardware_counter_create();
    hardware_counts counts = hardware_counter_read(counter);
    hardware_counter_destroy(counter);
    return counts.cycles >= 0;
}

static status look(account *a, diagnostic *why)
{
    status result = isa_choose(&a->chosen, why);
    if (result != STATUS_OK) {
        diagnostic_locate(why, "environment", 0, 0);
        return result;
    }
    a->best = isa_best();
    result = topology_create(&a->machine, why);
    if (result != STATUS_OK)
        return result;
    a->wall = clock_wall_quality();
    a->cpu = clock_thread_cpu_quality();
    a->has_hardware_counters = counts_cycles();
    uname(&a->kernel);
    a->disturbances = json_array();
    if (!a->disturbances)
        return diagnose(why, STATUS_FAILURE, "", "out of memory");
    usage_disturbances(LOAD_SAMPLE_S, add_disturbance, a->disturbances);
    return STATUS_OK;
}

static void print_text(const account *a)
{
    char *summary = topology_summary(a->machine);
    printf("machine         %s\n", summary ? summary : "unknown");
    free(summary);
    printf("usable          processing units %d, cores %d, packages %d\n", topology_pu_count(a->machine),
           topology_core_count(a->machine), topology_package_count(a->machine));
    printf("instructions    %s in use, %s is the best of this processor\n", isa_name(a->chosen), isa_name(a->best));
    printf("kernel          %s %s %s\n", a->kernel.sysname, a->kernel.release, a->kernel.machine);
    printf("wall clock      tick %.0f ns, a reading costs %.0f ns\n", a->wall.tick_s * 1e9, a->wall.overhead_s * 1e9);
    printf("thread clock    tick %.0f ns, a reading costs %.0f ns\n", a->cpu.tick_s * 1e9, a->cpu.overhead_s * 1e9);
    printf("hw counters     %s\n", a->has_hardware_counters ? "available" : "not available");
    printf("build           cuvette %s, compiler %s, %s\n", CUVETTE_VERSION, __VERSION__, CUVETTE_COMPILER_FLAGS);
    size_t i;
    json_t *line;
    json_array_foreach(a->disturbances, i, line)
        printf("%-15s %s\n", i == 0 ? "disturbances" : "", json_string_value(line));
    if (json_array_size(a->disturbances) == 0)
        printf("disturbances    none seen\n");
}

static json_t *clock_json(clock_quality clock)
{
    return json_pack("{s:o,s:o}", "tick_s", json_of_real(clock.tick_s), "overhead_s", json_of_real(clock.overhead_s));
}

static status print_json(const account *a, diagnostic *why)
{
    char *summary = topology_summary(a->machine);
    json_t *o = json_object();
    int bad = json_object_set_new(o, "schema", json_integer(1));
    bad |= json_object_set_new(o, "machine", summary ? json_of_text(summary) : json_null());
    bad |= json_object_set_new(o, "units", json_integer(topology_pu_count(a->machine)));
    bad |= json_object_set_new(o, "cores", json_integer(topology_core_count(a->machine)));
    bad |= json_object_set_new(o, "packages", json_integer(topology_package_count(a->machine)));
    bad |= json_object_set_new(o, "isa", json_string(isa_name(a->chosen)));
    bad |= json_object_set_new(o, "isa_best", json_string(isa_name(a->best)));
    bad |=
        json_object_set_new(o, "kernel", json_pack("[s,s,s]", a->kernel.sysname, a->kernel.release, a->kernel.machine));
    bad |= json_object_set_new(o, "wall_clock", clock_json(a->wall));
    bad |= json_object_set_new(o, "thread_clock", clock_json(a->cpu));
    bad |= json_object_set_new(o, "hardware_counters", json_boolean(a->has_hardware_counters));
    bad |= json_object_set_new(o, "version", json_string(CUVETTE_VERSION));
    bad |= json_object_set_new(o, "compiler", json_string(__VERSION__));
    bad |= json_object_set_new(o, "flags", json_string(CUVETTE_COMPILER_FLAGS));
    bad |= json_object_set(o, "disturbances", a->disturbances);
    status result = json_write(stdout, bad ? NULL : o, why);
    json_decref(o);
    free(summary);
    return result;
}

status command_machine(int argc, char **argv, diagnostic *why)
{
    bool as_json = false;
    account a = {0};
    status result = options_parse(&parser, 0, argc, argv, &as_json, why);
    if (result == STATUS_OK)
        result = look(&a, why);
    if (result == STATUS_OK && as_json)
        result = print_json(&a, why);
    else if (result == STATUS_OK)
        print_text(&a);
    json_decref(a.disturbances);
    topology_destroy(a.machine);
    return result;
}
