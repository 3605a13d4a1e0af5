/* Notes on a rendered frame: what its image lacks, and the remedy. Pure; ownership: values. */
#pragma once

#include "job/account.h"
#include "lint/lint.h"

/* Reports the notes on the account's frame; none if no frame is complete. */
void frame_notes(const job_account *a, const note_sink *taker);
