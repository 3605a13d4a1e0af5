/* The engine: the laboratory behind the page, which renders and answers the requests of the API (src/web/README.md).
 * It is the program that served the page, or a worker of this page. The page chooses by
 * <meta name="cuvette-engine" content="browser">; without it, by the program.
 *
 * exports: engine
 *   engine.kind                 'server' or 'browser'
 *   engine.fetch(path, {method, headers, body, signal, ..}) -> promise of a Response; rejects if there is no answer
 *   engine.events(names, {open(), error(), event(name, value)}) -> close(); open: events may have been missed before
 *   engine.address(path) -> promise of an address for images and links; engine.release(address) when it is shown
 *   engine.reconnects           whether an engine that does not answer may come back
 *   engine.lost() -> {error, remedy}     why it does not answer
 *   engine.idle()               whether no request waits for its reply */

import { createBrowserEngine } from './engine_browser.js';
import { createServerEngine } from './engine_server.js';

const chosen = document.querySelector('meta[name="cuvette-engine"]')?.content;

export const engine = chosen === 'browser' ? createBrowserEngine() : createServerEngine();
