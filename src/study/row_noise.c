#include "study/row_noise.h"
#include <math.h>

noise_verdict row_noise_judge(const noise_rule *rule, row_noise_columns *at, const row_ref *ref)
{
    if (ref->table != at->table)
        *at = (row_noise_columns){ref->table, csv_column(ref->table, "others_share"),
                                  csv_column(ref->table, "steal_share"), csv_column(ref->table, "frequency_drop"),
                                  csv_column(ref->table, "stalled_share")};
    const machine_noise noise = {
        csv_field_real(ref->table, ref->row, at->others), csv_field_real(ref->table, ref->row, at->steal), NAN,
        csv_field_real(ref->table, ref->row, at->drop), csv_field_real(ref->table, ref->row, at->stalled)};
    return noise_judge(rule, &noise, NULL);
}
