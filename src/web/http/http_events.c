/* Streams of server-sent events (HTML Standard, 9.2). Each stream has a short queue of payloads that are shared by
 * all streams; its connection's thread sleeps until an event arrives, the client leaves, or a keep-alive comment is
 * due. */
#include "base/json_build.h"
#include "web/http/http_library.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

/* SLOW_CLIENT_TIMEOUTS: a client may leave an event unread for this multiple of timeout_s. */
enum { NAME_MAX_LENGTH = 63, SLOW_CLIENT_TIMEOUTS = 6 };

/* Reference-counted under event_lock. */
typedef struct payload {
    int references;
    size_t size;
    char name[NAME_MAX_LENGTH + 1];
    char text[];
} payload;

struct http_event_client {
    http_server *server;
    struct MHD_Connection *connection;
    int socket, wake, place; /* wake: an eventfd */
    int waiting;
    payload *queue[HTTP_EVENTS_WAITING]; /* oldest first */
    payload *sending;                    /* only the client's thread uses it */
    size_t sent;
    bool header_sent;
};

static void payload_release(payload *p)
{
    if (--p->references == 0)
        free(p);
}

static ssize_t send_comment(http_event_client *c, char *to, size_t room)
{
    static const char text[] = ":\n\n";
    if (room < sizeof text - 1)
        return MHD_CONTENT_READER_END_WITH_ERROR;
    memcpy(to, text, sizeof text - 1);
    http_watch_deadline(c->server, c->connection, SLOW_CLIENT_TIMEOUTS * c->server->settings.timeout_s);
    return sizeof text - 1;
}

static ssize_t send_rest(http_event_client *c, char *to, size_t room)
{
    const size_t left = c->sending->size - c->sent, size = left < room ? left : room;
    memcpy(to, c->sending->text + c->sent, size);
    c->sent += size;
    if (c->sent == c->sending->size) {
        pthread_mutex_lock(&c->server->event_lock);
        payload_release(c->sending);
        pthread_mutex_unlock(&c->server->event_lock);
        c->sending = NULL;
    }
    http_watch_deadline(c->server, c->connection, SLOW_CLIENT_TIMEOUTS * c->server->settings.timeout_s);
    return (ssize_t)size;
}

/* Pops the oldest payload; false when the streams end. */
static bool pop_payload(http_event_client *c)
{
    pthread_mutex_lock(&c->server->event_lock);
    const bool ends = c->server->events_end;
    if (!ends && c->waiting) {
        c->sending = c->queue[0];
        c->sent = 0;
        memmove(c->queue, c->queue + 1, (size_t)--c->waiting * sizeof *c->queue);
    }
    pthread_mutex_unlock(&c->server->event_lock);
    return !ends;
}

/* libmicrohttpd's content callback; it may block, because the bytes returned before are already sent. */
static ssize_t read_stream(void *context, uint64_t position, char *to, size_t room)
{
    (void)position;
    http_event_client *c = context;
    if (!c->header_sent) { /* sends the header, so that the page knows that the stream is open */
        c->header_sent = true;
        return send_comment(c, to, room);
    }
    if (c->sending)
        return send_rest(c, to, room);
    http_watch_deadline(c->server, c->connection, 0);
    for (;;) {
        if (!pop_payload(c))
            return MHD_CONTENT_READER_END_OF_STREAM;
        if (c->sending)
            return send_rest(c, to, room);
        struct pollfd wait[2] = {{.fd = c->wake, .events = POLLIN}, {.fd = c->socket, .events = POLLRDHUP}};
        const int ready = poll(wait, 2, HTTP_HEARTBEAT_MS);
        if (ready == 0)
            return send_comment(c, to, room);
        if ((ready < 0 && errno != EINTR) || (ready > 0 && wait[1].revents))
            return MHD_CONTENT_READER_END_WITH_ERROR;
        uint64_t count;
        if (ready > 0 && read(c->wake, &count, sizeof count) < 0 && errno != EAGAIN)
            return MHD_CONTENT_READER_END_WITH_ERROR;
    }
}

static void client_free(void *context)
{
    http_event_client *c = context;
    http_server *s = c->server;
    pthread_mutex_lock(&s->event_lock);
    if (c->place >= 0) {
        s->event_client[c->place] = NULL;
        s->event_client_count--;
    }
    for (int i = 0; i < c->waiting; i++)
        payload_release(c->queue[i]);
    if (c->sending)
        payload_release(c->sending);
    pthread_mutex_unlock(&s->event_lock);
    if (c->wake >= 0)
        close(c->wake);
    free(c);
}

/* False if all slots are taken, or the streams end. */
static bool add_client(http_server *s, http_event_client *c)
{
    pthread_mutex_lock(&s->event_lock);
    for (int i = 0; i < s->settings.event_clients && !s->events_end && c->place < 0; i++)
        if (!s->event_client[i]) {
            s->event_client[i] = c;
            s->event_client_count++;
            c->place = i;
        }
    pthread_mutex_unlock(&s->event_lock);
    return c->place >= 0;
}

void http_events(void *context, const http_request *q, http_reply *r)
{
    (void)context;
    http_server *s = q->server;
    http_event_client *c = calloc(1, sizeof *c);
    if (!c)
        return;
    const union MHD_ConnectionInfo *info = mhd.get_connection_info(q->connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    *c = (http_event_client){.server = s,
                             .connection = q->connection,
                             .socket = info ? info->connect_fd : -1,
                             .place = -1,
                             .wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
    struct MHD_Response *response = NULL;
    if (c->wake < 0 || !add_client(s, c))
        http_reply_error(r, 503, "too many event streams are open", "close another page of this laboratory");
    else
        response = mhd.create_response_from_callback(MHD_SIZE_UNKNOWN, 16384, read_stream, c, client_free);
    if (response)
        http_reply_set(r, 200, "text/event-stream", response);
    else
        client_free(c);
}

static bool is_event_name(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    const size_t length = strlen(name);
    return length >= 1 && length <= NAME_MAX_LENGTH && strspn(name, letters) == length;
}

/* "event: NAME", "data: VALUE", an empty line; compact JSON has no line breaks. */
static payload *payload_of(const char *name, const json_t *value)
{
    char *json = json_text(value, JSON_COMPACT | JSON_ENCODE_ANY);
    if (!json)
        return NULL;
    static const char event[] = "event: ", data[] = "\ndata: ", end[] = "\n\n";
    payload *p = malloc(sizeof *p + strlen(name) + strlen(json) + sizeof event + sizeof data + sizeof end);
    if (p) {
        strcpy(p->name, name);
        char *to = stpcpy(stpcpy(stpcpy(stpcpy(stpcpy(p->text, event), name), data), json), end);
        p->size = (size_t)(to - p->text);
        p->references = 1;
    }
    free(json);
    return p;
}

static void enqueue(http_event_client *c, payload *p)
{
    int drop = 0;
    while (drop < c->waiting && strcmp(c->queue[drop]->name, p->name) != 0)
        drop++;
    if (drop == c->waiting)
        drop = c->waiting == HTTP_EVENTS_WAITING ? 0 : -1;
    if (drop >= 0) {
        payload_release(c->queue[drop]);
        memmove(c->queue + drop, c->queue + drop + 1, (size_t)(--c->waiting - drop) * sizeof *c->queue);
    }
    c->queue[c->waiting++] = p;
    p->references++;
}

static void wake(const http_event_client *c)
{
    const uint64_t one = 1;
    while (write(c->wake, &one, sizeof one) < 0 && errno == EINTR)
        continue;
}

status http_publish(http_server *s, const char *event, const json_t *value, diagnostic *why)
{
    if (!is_event_name(event))
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 63 letters, digits, '-', '_' or '.'",
                        "\"%s\" is not a valid event name", event);
    payload *p = payload_of(event, value);
    if (!p)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the event %s", event);
    pthread_mutex_lock(&s->event_lock);
    for (int i = 0; i < s->settings.event_clients; i++)
        if (s->event_client[i]) {
            enqueue(s->event_client[i], p);
            wake(s->event_client[i]);
        }
    payload_release(p);
    pthread_mutex_unlock(&s->event_lock);
    return STATUS_OK;
}

int http_event_clients(http_server *s)
{
    pthread_mutex_lock(&s->event_lock);
    const int count = s->event_client_count;
    pthread_mutex_unlock(&s->event_lock);
    return count;
}

void http_events_end(http_server *s)
{
    pthread_mutex_lock(&s->event_lock);
    s->events_end = true;
    for (int i = 0; i < HTTP_EVENT_CLIENTS_MAX; i++)
        if (s->event_client[i])
            wake(s->event_client[i]);
    pthread_mutex_unlock(&s->event_lock);
}
