/* `cuvette machine`: hardware, clocks, and what disturbs measurements. */
#include "cli/cli.h"
#include "report/json.h"
#include "cli/options.h"
#include "report/machine.h"
#include <stdio.h>
#include <stdlib.h>

static const command_option options[] = {
    {"json", 0, NULL, "print JSON", .take = option_flag},
    {0},
};

static const command_form form = {
    .options = options,
    .excess_remedy = "remove it",
    .excess = "unexpected argument '%.128s'",
    .about = "Describe this machine: processors and caches, resolution and overhead of the clocks, the vector "
             "instruction set in use, and what could currently disturb a measurement.",
};

static void print_text(const machine_account *a)
{
    char *summary = topology_summary(a->machine);
    printf("machine         %s\n", summary ? summary : "unknown");
    free(summary);
    printf("usable          processing units %d, cores %d, packages %d\n", topology_pu_count(a->machine),
           topology_core_count(a->machine), topology_package_count(a->machine));
    printf("instructions    %s in use, %s is the best that this processor has\n", isa_name(a->chosen),
           isa_name(a->best));
    printf("kernel          %s %s %s\n", a->kernel.sysname, a->kernel.release, a->kernel.machine);
    printf("wall clock      resolution %.0f ns, overhead %.0f ns a reading\n", a->wall.tick_s * 1e9,
           a->wall.overhead_s * 1e9);
    printf("thread clock    resolution %.0f ns, overhead %.0f ns a reading\n", a->cpu.tick_s * 1e9,
           a->cpu.overhead_s * 1e9);
    printf("hw counters     %s\n", a->has_hardware_counters ? "available" : "not available");
    printf("build           cuvette %s, compiler %s, %s\n", CUVETTE_VERSION, __VERSION__, CUVETTE_COMPILER_FLAGS);
    size_t i;
    json_t *line;
    json_array_foreach(a->disturbances, i, line)
        printf("%-15s %s\n", i == 0 ? "disturbances" : "", json_string_value(line));
    if (json_array_size(a->disturbances) == 0)
        printf("disturbances    none found\n");
}

status command_machine(int argc, char **argv, diagnostic *why)
{
    bool as_json = false;
    machine_account a = {0};
    status result = command_form_read(&form, argc, argv, &as_json, why);
    THEN(result, machine_measure(&a, why));
    if (result == STATUS_OK && as_json)
        result = json_print(machine_json(&a), why);
    else if (result == STATUS_OK)
        print_text(&a);
    machine_release(&a);
    return result;
}
