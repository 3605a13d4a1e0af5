/* Detection of disturbances of a measurement, read from /proc and /sys below any root, so that it can be tested with
 * copies of any machine's files. Private to src/measure; the public function is usage_disturbances. */
#pragma once

typedef void (*disturbance_line)(void *context, const char *text);

/* root is "" for this machine. Reports settings (governor, turbo, threads per core, hypervisor, quota), then load and
 * swap. */
void disturbances_of_machine(const char *root, disturbance_line line, void *context);
