/* `cuvette study run --dry-run`. */
#include "cli/study_commands.h"
#include "base/text.h"
#include "cli/terminal.h"
#include "study/run/estimate.h"
#include <stdlib.h>

status study_check_room(const study *s, const study_request *request, const study_estimate *e, diagnostic *why)
{
    char note[DISK_ROOM_TEXT_MAX];
    char *folder = text_format("%s/%s", request->results, s->name);
    if (!folder)
        return out_of_memory(why);
    const status result = disk_room_check(&e->needed, e->free_bytes, folder, "the run", note, why);
    free(folder);
    if (note[0])
        terminal_note(note);
    return result;
}

status study_dry_run(const study *s, const study_request *request, diagnostic *why)
{
    const study_options options = {.results = request->results,
                                   .shard = request->shard,
                                   .shards = request->shards,
                                   .by_repetition = request->by_repetition,
                                   .any_environment = request->any_environment};
    study_estimate e;
    TRY(study_estimate_run(s, &options, &e, why));
    if (request->quiet)
        return STATUS_OK;
    study_estimate_write(stdout, s, request->results, &e);
    TRY(terminal_flush(why));
    return study_check_room(s, request, &e, why);
}
