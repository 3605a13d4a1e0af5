/* Requests of the page to a laboratory in a browser, as messages: the routes and handlers are those of the server
 * (web/http/http.h), without its checks, which protect a server from strangers. One thread: a request whose handler had
 * to wait for an image is kept and handled again later. */
#pragma once

/* Handles the waiting requests again, each at most once. Something that they may wait for has happened. */
void requests_retry(void);
