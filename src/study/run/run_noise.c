/* Judges the noise of a running study: rows by the study's rule, with news for the user, and the machine while it waits
 * for quiet. Measured times play no role. */
#include "base/cancel.h"
#include "measure/clock.h"
#include "study/run/run_state.h"
#include <math.h>
#include <stdio.h>
#include <time.h>

/* The least time between news of one kind. */
static const double NEWS_APART_S = 60;

/* The rule for news: the study's rule, with defaults for bounds that it lacks. */
static noise_rule rule_of_news(const noise_rule *rule)
{
    return (noise_rule){.others_fraction = isnan(rule->others_fraction) ? 0.05 : rule->others_fraction,
                        .steal_fraction = isnan(rule->steal_fraction) ? 0.01 : rule->steal_fraction,
                        .frequency_drop = isnan(rule->frequency_drop) ? 0.1 : rule->frequency_drop,
                        .stalled_fraction = isnan(rule->stalled_fraction) ? 0.1 : rule->stalled_fraction};
}

static void describe(noise_kind kind, const machine_noise *noise, char *text, size_t size)
{
    switch (kind) {
    case NOISE_OTHERS:
        snprintf(text, size, "other processes use %.0f%% of the machine: stop them, or measure with --wait-quiet",
                 100 * noise->others_fraction);
        return;
    case NOISE_STEAL:
        snprintf(text, size, "the hypervisor withholds %.1f%% of the machine: measure at another time or place",
                 100 * noise->steal_fraction);
        return;
    case NOISE_FREQUENCY:
        snprintf(text, size, "the clock frequency fell by %.0f%% to %.2f GHz: heat, or the governor",
                 100 * noise->frequency_drop, noise->frequency_hz * 1e-9);
        return;
    case NOISE_STALLED:
        snprintf(
            text, size,
            "the program could not run for %.0f%% of a frame: it was stopped, frozen, throttled by a quota, or others "
            "had its processing units",
            100 * noise->stalled_fraction);
        return;
    case NOISE_KINDS: break;
    }
    text[0] = '\0';
}

static void report_news(run *r, const char *text)
{
    if (!r->options->news)
        return;
    progress_erase_line(r->line);
    r->options->news(r->options->context, text);
}

noise_verdict run_noise_judge(run *r, const machine_noise *noise)
{
    bool exceeded[NOISE_KINDS];
    const noise_rule news = rule_of_news(&r->s->disturbed);
    const double now_s = clock_wall_s();
    (void)noise_judge(&news, noise, exceeded);
    for (noise_kind kind = 0; kind < NOISE_KINDS; kind++) {
        char text[200];
        if (!exceeded[kind] || now_s < r->next_news_s[kind])
            continue;
        r->next_news_s[kind] = now_s + NEWS_APART_S;
        describe(kind, noise, text, sizeof text);
        report_news(r, text);
    }
    return noise_judge(&r->s->disturbed, noise, NULL);
}

status run_noise_wait(run *r, diagnostic *why)
{
    const double most_s = r->options->wait_quiet_s, began_s = clock_wall_s();
    const noise_rule rule = rule_of_news(&r->s->disturbed);
    while (most_s > 0) {
        const machine_noise noise = job_noise(r->frame_job);
        if (noise_judge(&rule, &noise, NULL) != NOISE_DISTURBED)
            return STATUS_OK;
        if (clock_wall_s() - began_s >= most_s) {
            char text[120];
            snprintf(text, sizeof text, "the machine is not quiet after %g s; measuring anyway", most_s);
            if (!r->reported_waiting)
                report_news(r, text);
            r->reported_waiting = true;
            return STATUS_OK;
        }
        if (cancel_hurries()) /* the run is shielded, so that it does not see the cancellation itself */
            return diagnose(why, STATUS_INTERRUPTED, "run the command again to resume",
                            "interrupted; all completed rows are kept");
        nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
    }
    return STATUS_OK;
}
