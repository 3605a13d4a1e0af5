/* Subcommands of `cuvette study` with a file of their own. Ownership: everything is borrowed. Errors are located at the
 * command line or in the study file. */
#pragma once

#include "cli/study_request.h"
#include "study/run/estimate.h"
#include "study/study.h"

/* `study new`: writes a study file. */
status study_new(int argc, char **argv, diagnostic *why);

/* `study list`: the studies of a folder, and the scenes of its folder scenes. */
status study_list(int argc, char **argv, diagnostic *why);
/* `study submit`: the missing parts of a study as an array job of a cluster. */
status study_submit(int argc, char **argv, diagnostic *why);
/* `study exclude`: excludes a row from summaries. */
status study_exclude(int argc, char **argv, diagnostic *why);
/* `study compare`: the ratio of two sides of a study, with a verdict. */
status study_compare(int argc, char **argv, diagnostic *why);
/* `study films`: whether two results folders have the same films and ray counts. */
status study_films_command(int argc, char **argv, diagnostic *why);
/* `study power`: false claims and missed differences of smaller studies, drawn from measured rows. */
status study_power(int argc, char **argv, diagnostic *why);

/* The repetitions of a study that divides them among processes, each a program of its own, one after the other; with
 * --against=PROGRAM each followed or preceded, at random, by the same process of the other program, whose rows go to
 * the results folder with -against: two builds that alternate can be compared. */
status study_run_processes(const study *s, const study_request *request, diagnostic *why);

/* STATUS_FAILURE where what the run writes cannot fit; a note where it may not. */
status study_check_room(const study *s, const study_request *request, const study_estimate *e, diagnostic *why);

/* `study run --dry-run`: prints what a run would measure and keep, and about how long it would take. */
status study_dry_run(const study *s, const study_request *request, diagnostic *why);
