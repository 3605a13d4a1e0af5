/* What could disturb a measurement, read from /proc and /sys below any root, so that it can be tested on a copy of
 * any machine's files. Inside this room; usage_disturbances is the door. */
#pragma once

typedef void (*disturbance_line)(void *context, const char *text);

/* root is "" for this machine. Settings (governor, turbo, threads of one core, hypervisor, quota), then load and swap.
 */
void disturbances_of_machine(const char *root, disturbance_line line, void *context);
