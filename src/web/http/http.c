/* Start and stop of the HTTP server. */
#include "base/text.h"
#include "web/http/http_library.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

/* Opens the socket, because libmicrohttpd would let another program share its port (SO_REUSEPORT). */
static status listen_at(int port, int backlog, int *out, diagnostic *why)
{
    const int fd = *out = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd < 0)
        return diagnose(why, STATUS_FAILURE, "", "cannot create a socket: %s", strerror(errno));
    const int on = 1; /* allows a port that was just released */
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    const struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    if (bind(fd, (const struct sockaddr *)&address, sizeof address) == 0 && listen(fd, backlog) == 0)
        return STATUS_OK;
    diagnose(why, STATUS_BAD_INPUT, "choose another port, or 0 for any free port",
             "cannot listen on port %d of 127.0.0.1: %s", port, strerror(errno));
    close(fd);
    return STATUS_BAD_INPUT;
}

static status check(http_settings *s, diagnostic *why)
{
    if (s->port < 0 || s->port > 65535)
        return diagnose(why, STATUS_BAD_INPUT, "use a port from 1 to 65535, or 0 for any free port",
                        "port %d is out of range", s->port);
    s->body_max = s->body_max ? s->body_max : (size_t)1 << 20;
    s->connections = s->connections ? s->connections : 64;
    if (s->connections < 1 || s->connections > 1024)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 1024 connections",
                        "the number of connections, %d, is out of range", s->connections);
    if (!s->event_clients)
        s->event_clients = s->connections / 2 < 32 ? s->connections / 2 : 32;
    if (s->event_clients < 0 || s->event_clients > HTTP_EVENT_CLIENTS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 512 event streams, or 0 for the default",
                        "the number of event streams, %d, is out of range", s->event_clients);
    if (s->frame_origin_count > HTTP_FRAME_ORIGINS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use at most 8 origins", "there are too many origins");
    for (size_t i = 0; i < s->frame_origin_count; i++)
        if (!http_is_origin(s->frame_origins[i]))
            return diagnose(why, STATUS_BAD_INPUT, "use an origin such as https://lms.example",
                            "'%.128s' is not an origin", s->frame_origins[i]);
    s->timeout_s = s->timeout_s > 0 ? s->timeout_s : 10;
    s->requests_per_s = s->requests_per_s > 0 ? s->requests_per_s : 2000;
    return STATUS_OK;
}

static bool is_host(const char *text, size_t length)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789-.";
    return length > 0 && length < 254 && strspn(text, letters) == length && text[0] != '.' && text[0] != '-';
}

bool http_is_origin(const char *text)
{
    const size_t scheme = strncmp(text, "https://", 8) == 0 ? 8 : strncmp(text, "http://", 7) == 0 ? 7 : 0;
    const char *host = text + scheme;
    const size_t length = strcspn(host, ":"); /* no IPv6: frame-ancestors cannot name it */
    const char *port = host + length;
    const size_t digits = port[0] ? strspn(port + 1, "0123456789") : 0;
    if (port[0] && (port[0] != ':' || digits < 1 || digits > 5 || port[1 + digits] || atoi(port + 1) > 65535))
        return false;
    return scheme && is_host(host, length);
}

/* The page loads only from this server; who may show it in a frame is in the settings. */
static status make_content_policy(http_server *s, diagnostic *why)
{
    static const char format[] =
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; media-src blob:; "
        "connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors%s";
    char *origins = strdup(s->settings.frame_origin_count ? "" : " 'none'");
    for (size_t i = 0; origins && i < s->settings.frame_origin_count; i++) {
        char *more = text_format("%s %s", origins, s->settings.frame_origins[i]);
        free(origins);
        origins = more;
    }
    s->content_policy = origins ? text_format(format, origins) : NULL;
    free(origins);
    return s->content_policy ? STATUS_OK : out_of_memory(why);
}

static status make_token(http_server *s, diagnostic *why)
{
    unsigned char bits[HTTP_TOKEN_DIGITS / 2];
    if (getrandom(bits, sizeof bits, 0) != (ssize_t)sizeof bits)
        return diagnose(why, STATUS_FAILURE, "", "cannot get random numbers: %s", strerror(errno));
    for (size_t i = 0; i < sizeof bits; i++)
        snprintf(s->token + 2 * i, 3, "%02x", bits[i]);
    explicit_bzero(bits, sizeof bits);
    return STATUS_OK;
}

/* Closes the socket of a server that did not start. libmicrohttpd has closed it already, unless it was not started or
 * its first allocation failed. The number of a closed socket may belong to another file now, so the inode decides. */
static void close_unserved(int fd, const struct stat *listening)
{
    struct stat now;
    if (fstat(fd, &now) == 0 && now.st_dev == listening->st_dev && now.st_ino == listening->st_ino)
        close(fd);
}

static status listen_and_serve(http_server *s, diagnostic *why)
{
    int fd;
    struct stat listening;
    TRY(listen_at(s->settings.port, s->settings.connections, &fd, why));
    struct sockaddr_in address = {0};
    socklen_t size = sizeof address;
    if (fstat(fd, &listening) != 0 || getsockname(fd, (struct sockaddr *)&address, &size) != 0) {
        close(fd);
        return diagnose(why, STATUS_FAILURE, "", "cannot get the port of the socket: %s", strerror(errno));
    }
    s->port = ntohs(address.sin_port);
    snprintf(s->address, sizeof s->address, "http://127.0.0.1:%d/?token=%s", s->port, s->token);
    snprintf(s->cookie, sizeof s->cookie, "cuvette_%d", s->port);

    /* Block all signals in the server's threads: the program's own threads handle them. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    status code = http_watch_start(s, why);
    if (code == STATUS_OK) {
        s->daemon = mhd.start_daemon(
            MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION | MHD_USE_POLL, 0, NULL, NULL,
            http_on_request, s, MHD_OPTION_LISTEN_SOCKET, fd, MHD_OPTION_CONNECTION_LIMIT,
            (unsigned)s->settings.connections, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)s->settings.timeout_s,
            MHD_OPTION_NONCE_NC_SIZE, 0u, /* nonces of digest authentication, which is not used */
            MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)32768, MHD_OPTION_STRICT_FOR_CLIENT, 1,
            MHD_OPTION_URI_LOG_CALLBACK, http_on_target, s, MHD_OPTION_NOTIFY_COMPLETED, http_on_end, s,
            MHD_OPTION_NOTIFY_CONNECTION, http_watch_notify, s, MHD_OPTION_END);
        if (!s->daemon)
            code = http_no_threads(why);
    }
    if (code != STATUS_OK)
        close_unserved(fd, &listening);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return code;
}

status http_start(const http_settings *settings, http_server **out, diagnostic *why)
{
    *out = NULL;
    http_server *s = calloc(1, sizeof *s);
    if (!s)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the server");
    s->settings = *settings;
    pthread_mutex_init(&s->bucket_lock, NULL);
    pthread_mutex_init(&s->watch_lock, NULL);
    pthread_mutex_init(&s->event_lock, NULL);
    pthread_cond_init(&s->watch_wake, NULL);
    status code = check(&s->settings, why);
    THEN(code, http_library_load(why));
    THEN(code, make_content_policy(s, why));
    THEN(code, make_token(s, why));
    THEN(code, listen_and_serve(s, why));
    if (code != STATUS_OK) {
        http_stop(s);
        return code;
    }
    *out = s;
    return STATUS_OK;
}

void http_stop(http_server *s)
{
    if (!s)
        return;
    http_events_end(s);
    if (s->daemon)
        mhd.stop_daemon(s->daemon);
    http_watch_stop(s);
    pthread_cond_destroy(&s->watch_wake);
    pthread_mutex_destroy(&s->event_lock);
    pthread_mutex_destroy(&s->watch_lock);
    pthread_mutex_destroy(&s->bucket_lock);
    free(s->content_policy);
    explicit_bzero(s, sizeof *s);
    free(s);
}

int http_port(const http_server *s)
{
    return s->port;
}

const char *http_token(const http_server *s)
{
    return s->token;
}

const char *http_address(const http_server *s)
{
    return s->address;
}
