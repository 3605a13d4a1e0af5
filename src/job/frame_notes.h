/* Notes on a rendered frame: what its image lacks, and the remedy. Pure; ownership: values. */
#pragma once

#include "job/account.h"
#include "lint/lint.h"

/* Passes the notes on the account's frame to the callback, none before a frame is complete. */
void frame_notes(const job_account *a, const note_taker *taker);
