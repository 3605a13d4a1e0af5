/* `cuvette study run --dry-run`. */
#include "cli/study_commands.h"
#include "cli/terminal.h"
#include "study/estimate.h"

status study_dry_run(const study *s, const study_request *request, diagnostic *why)
{
    const study_options options = {.results = request->results,
                                   .shard = request->shard,
                                   .shards = request->shards,
                                   .by_repetition = request->by_repetition,
                                   .any_environment = request->any_environment,
                                   .stop = terminal_stop_requested};
    study_estimate e;
    TRY(study_estimate_run(s, &options, &e, why));
    if (request->quiet)
        return STATUS_OK;
    study_estimate_write(stdout, s, request->results, &e);
    return terminal_flush(why);
}
