/* `cuvette machine`: hardware, clocks, and what disturbs measurements. */
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/terminal.h"
#include "measure/usage.h"
#include "report/json.h"
#include "report/report.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const command_option options[] = {
    {"json", 0, NULL, "print JSON", .store = option_flag},
    {0},
};

static const command_form form = {
    .options = options,
    .excess_remedy = "remove it",
    .excess = "unexpected argument '%.128s'",
    .about = "Describe this machine: processors and caches, resolution and overhead of the clocks, the vector "
             "instruction set in use, and what could currently disturb a measurement.",
};

static void print_disturbance(int columns, const char *label, const char *text)
{
    const char *advice = disturbance_advice(text);
    wrap_row(stdout, columns, label, "%s%s%s", text, advice[0] ? ": " : "", advice);
}

static void print_text(const machine_report *a)
{
    const int columns = terminal_columns(STDOUT_FILENO);
    char *summary = topology_summary(a->machine);
    wrap_row(stdout, columns, "machine         ", "%s", summary ? summary : "unknown");
    free(summary);
    wrap_row(stdout, columns, "usable          ", "processing units %d, cores %d, packages %d",
             topology_pu_count(a->machine), topology_core_count(a->machine), topology_package_count(a->machine));
    wrap_row(stdout, columns, "instructions    ", "%s in use, %s is the best that this processor has",
             isa_name(a->chosen), isa_name(a->best));
    wrap_row(stdout, columns, "kernel          ", "%s %s %s", a->kernel.sysname, a->kernel.release, a->kernel.machine);
    wrap_row(stdout, columns, "wall clock      ", "resolution %.0f ns, overhead %.0f ns per reading",
             a->wall.tick_s * 1e9, a->wall.overhead_s * 1e9);
    wrap_row(stdout, columns, "thread clock    ", "resolution %.0f ns, overhead %.0f ns per reading",
             a->cpu.tick_s * 1e9, a->cpu.overhead_s * 1e9);
    wrap_row(stdout, columns, "hw counters     ", "%s", a->has_hardware_counters ? "available" : "not available");
    wrap_row(stdout, columns, "build           ", "cuvette %s, compiler %s, %s", CUVETTE_VERSION, __VERSION__,
             CUVETTE_COMPILER_FLAGS);
    size_t i;
    json_t *line;
    json_array_foreach(a->disturbances, i, line)
        print_disturbance(columns, i == 0 ? "disturbances    " : "                ", json_string_value(line));
    if (json_array_size(a->disturbances) == 0)
        wrap_row(stdout, columns, "disturbances    ", "none found");
}

status command_machine(int argc, char **argv, diagnostic *why)
{
    bool as_json = false;
    machine_report a = {0};
    status result = command_form_read(&form, argc, argv, &as_json, why);
    THEN(result, machine_measure(&a, why));
    if (result == STATUS_OK && as_json)
        result = json_print(machine_json(&a), why);
    else if (result == STATUS_OK)
        print_text(&a);
    machine_release(&a);
    return result;
}
