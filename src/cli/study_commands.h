/* Subcommands of `cuvette study` with a file of their own. Ownership: everything is borrowed. Errors are located at the
 * command line or in the study file. */
#pragma once

#include "cli/study_request.h"
#include "study/study.h"

/* `study new`: writes a study file. */
status study_new(int argc, char **argv, diagnostic *why);

/* `study run --dry-run`: prints what a run would measure and keep, and about how long it would take. */
status study_dry_run(const study *s, const study_request *request, diagnostic *why);
