/* The watchdog of slow connections. libmicrohttpd closes connections that are idle, but not those that send a byte
 * now and then. So each connection has a slot with the deadline of its request or reply, and a thread checks all
 * slots once a second. Strangers, connections that have sent no request with the token, have a lower limit, so that
 * they cannot use all connections: a new stranger displaces the oldest. */
#include "base/float_environment.h"
#include "measure/clock.h"
#include "web/http/http_library.h"

#include <math.h>
#include <stdlib.h>
#include <sys/socket.h>

static void *watch(void *context)
{
    http_server *s = context;
    float_environment_set();
    pthread_mutex_lock(&s->watch_lock);
    while (!s->watch_ends) {
        const double now_s = clock_wall_s();
        for (int i = 0; i < s->settings.connections; i++) {
            http_slot *slot = &s->slots[i];
            if (slot->socket >= 0 && slot->deadline_s > 0 && now_s > slot->deadline_s) {
                shutdown(slot->socket, SHUT_RDWR); /* the connection's thread notices and closes it */
                slot->deadline_s = 0;
            }
        }
        const struct timespec next = clock_after(1.0);
        pthread_cond_clockwait(&s->watch_wake, &s->watch_lock, CLOCK_MONOTONIC, &next);
    }
    pthread_mutex_unlock(&s->watch_lock);
    return NULL;
}

status http_no_threads(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, "close other programs, or raise the limits (ulimit -u, ulimit -n)",
                    "cannot start the server's threads, for lack of memory, threads or open files");
}

status http_watch_start(http_server *s, diagnostic *why)
{
    s->slots = calloc((size_t)s->settings.connections, sizeof *s->slots);
    if (!s->slots)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for %d connections",
                        s->settings.connections);
    for (int i = 0; i < s->settings.connections; i++)
        s->slots[i].socket = -1;
    s->watching = pthread_create(&s->watch, NULL, watch, s) == 0;
    return s->watching ? STATUS_OK : http_no_threads(why);
}

void http_watch_stop(http_server *s)
{
    if (s->watching) {
        pthread_mutex_lock(&s->watch_lock);
        s->watch_ends = true;
        pthread_cond_signal(&s->watch_wake);
        pthread_mutex_unlock(&s->watch_lock);
        pthread_join(s->watch, NULL);
    }
    free(s->slots);
}

/* Strangers may have at most one in STRANGERS_PART connections. */
enum { STRANGERS_PART = 4 };

/* Closes the oldest stranger's connection if they have reached their limit. The caller holds the lock. */
static void displace_stranger(http_server *s)
{
    http_slot *oldest = NULL;
    int strangers = 0;
    for (int i = 0; i < s->settings.connections; i++) {
        http_slot *slot = &s->slots[i];
        if (slot->socket < 0 || slot->known)
            continue;
        strangers++;
        if (!oldest || slot->started_s < oldest->started_s)
            oldest = slot;
    }
    if (oldest && strangers * STRANGERS_PART > s->settings.connections) {
        shutdown(oldest->socket, SHUT_RDWR); /* the connection's thread notices and closes it */
        oldest->started_s = INFINITY;        /* do not choose it again meanwhile */
    }
}

static http_slot *slot_of(struct MHD_Connection *c)
{
    const union MHD_ConnectionInfo *info = mhd.get_connection_info(c, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? info->socket_context : NULL;
}

void http_watch_notify(void *context, struct MHD_Connection *c, void **slot, enum MHD_ConnectionNotificationCode what)
{
    http_server *s = context;
    pthread_mutex_lock(&s->watch_lock);
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info = mhd.get_connection_info(c, MHD_CONNECTION_INFO_CONNECTION_FD);
        for (int i = 0; i < s->settings.connections && info && !*slot; i++)
            if (s->slots[i].socket < 0) {
                const double now_s = clock_wall_s();
                s->slots[i] = (http_slot){
                    .socket = info->connect_fd, .deadline_s = now_s + s->settings.timeout_s, .started_s = now_s};
                *slot = &s->slots[i];
                displace_stranger(s);
            }
    } else if (*slot) {
        ((http_slot *)*slot)->socket = -1;
        *slot = NULL;
    }
    pthread_mutex_unlock(&s->watch_lock);
}

void http_watch_deadline(http_server *s, struct MHD_Connection *c, double in_s)
{
    http_slot *slot = slot_of(c);
    pthread_mutex_lock(&s->watch_lock);
    if (slot)
        slot->deadline_s = in_s > 0 ? clock_wall_s() + in_s : 0;
    pthread_mutex_unlock(&s->watch_lock);
}

void http_watch_known(http_server *s, struct MHD_Connection *c)
{
    http_slot *slot = slot_of(c);
    pthread_mutex_lock(&s->watch_lock);
    if (slot)
        slot->known = true;
    pthread_mutex_unlock(&s->watch_lock);
}
