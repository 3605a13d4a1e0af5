/* What disturbs a running study: the judgement of its rows by the study's rule, news for the user, and waiting for a
 * quiet machine. The measured times are never looked at. */
#pragma once

#include "study/run_state.h"

/* The verdict of the study's rule; reports what disturbs. */
noise_verdict run_noise_judge(run *r, const machine_noise *noise);

/* With options->wait_quiet_s: waits until nothing disturbs, at most that long. STATUS_INTERRUPTED after a stop
 * request. */
status run_noise_wait(run *r, diagnostic *why);
