/* Runs a function in a thread of its own that can only compute: it opens nothing, sends nothing and starts nothing
 * (base/os_confine.h), whatever a damaged file makes it do. The memory is the same, so this is a second obstacle, and
 * not a wall such as that around the importer's process; it takes 0.1 ms. Where there is no such thread,
 * or it cannot be confined, the function runs all the same. Cancelling the caller cancels it (base/cancel.h), and the
 * caller's memory budget is its own. Signals are left to other threads. */
#pragma once

void apart_run(void (*work)(void *context), void *context);
