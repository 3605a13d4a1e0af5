/* Measures this machine's clocks and disturbances, and reports them as JSON. */
#include "base/json_build.h"
#include "measure/usage.h"
#include "report/json.h"
#include "report/report.h"
#include <stdlib.h>

#define LOAD_SAMPLE_S 0.5 /* 50 ticks of /proc/stat */

static void add_disturbance(void *context, const char *text)
{
    json_add(context, json_of_text(text));
}

static bool counts_cycles(void)
{
    hardware_counter *counter = hardware_counter_create();
    hardware_counts counts = hardware_counter_read(counter);
    hardware_counter_destroy(counter);
    return counts.cycles >= 0;
}

status machine_measure(machine_report *a, diagnostic *why)
{
    status result = isa_choose(&a->chosen, why);
    if (result != STATUS_OK) {
        diagnostic_locate(why, "environment", 0, 0);
        return result;
    }
    a->best = isa_best();
    TRY(topology_create(&a->machine, why));
    a->wall = clock_wall_quality();
    a->cpu = clock_thread_cpu_quality();
    a->has_hardware_counters = counts_cycles();
    uname(&a->kernel);
    a->disturbances = json_array();
    disturbances_report(LOAD_SAMPLE_S, add_disturbance, &a->disturbances);
    return a->disturbances ? STATUS_OK : out_of_memory(why);
}

static json_t *clock_json(clock_quality clock)
{
    return json_pack("{s:o,s:o}", "tick_s", json_of_real(clock.tick_s), "overhead_s", json_of_real(clock.overhead_s));
}

json_t *machine_json(const machine_report *a)
{
    char *summary = topology_summary(a->machine);
    json_t *o = json_object();
    int bad = json_object_set_new(o, "schema", json_integer(1));
    bad |= json_object_set_new(o, "machine", summary ? json_of_text(summary) : NULL);
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
    free(summary);
    return json_if(o, bad == 0);
}

void machine_release(machine_report *a)
{
    json_decref(a->disturbances);
    topology_destroy(a->machine);
    *a = (machine_report){0};
}
