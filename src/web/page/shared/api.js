/* Requests of the laboratory's API to the engine.
 *
 * exports:
 *   createApi(engine, listeners) -> api
 *     api.get(path, limitMs), api.post(path, body), api.del(path)     JSON in and out; throw ApiError
 *     api.blob(path)                       an image or file: {blob, headers, seconds}, seconds from its first byte to
 *                                          its last; throws ApiError
 *     listeners: generation(number) for each reply with a generation, reached() for each reply, lost() when the engine
 *     does not answer, refused() for 401
 *   located(error)                         its message after file, line and column, as the program prints it
 * ApiError: message, remedy, status (0: no answer), and file, line, column if the reply has them. */

import { say, translated } from './language.js';

const LIMIT_MS = 60000;

class ApiError extends Error {
  constructor(status, reply = {}) {
    super(translated(reply.error) || say('the laboratory answered {status}', { status }));
    this.name = 'ApiError';
    this.status = status;
    this.remedy = translated(reply.remedy) || '';
    for (const key of ['file', 'line', 'column']) {
      if (reply[key] !== undefined) this[key] = reply[key];
    }
  }
}

export function located({ message, file, line, column }) {
  const place = line ? [file, line, column].filter(Boolean).join(':') : '';
  return place ? `${place}: ${message}` : message;
}

const stranger = () =>
  new ApiError(401, {
    error: "the server does not accept this page's token",
    remedy: 'open the address that cuvette lab printed when it started',
  });

async function parsed(response) {
  const text = await response.text();
  if (!text) return {};
  try {
    return JSON.parse(text);
  } catch {
    return { error: text.slice(0, 200) };
  }
}

export function createApi(engine, listeners) {
  const gone = () => new ApiError(0, engine.lost());

  async function ask(method, path, body, limitMs = LIMIT_MS) {
    const options = { method };
    if (engine.reconnects) options.signal = AbortSignal.timeout(limitMs); /* a worker in the page gets no time limit */
    if (method !== 'GET') {
      options.headers = { 'Content-Type': 'application/json' };
      options.body = JSON.stringify(body ?? {});
    }
    let response;
    try {
      response = await engine.fetch(path, options);
    } catch (cause) {
      if (cause.name === 'TimeoutError')
        throw new ApiError(0, { error: 'the server took too long', remedy: 'try again' });
      listeners.lost();
      throw gone();
    }
    if (response.status === 401) {
      listeners.refused();
      throw stranger();
    }
    listeners.reached();
    return response;
  }

  async function json(method, path, body, limitMs) {
    const response = await ask(method, path, body, limitMs);
    let reply;
    try {
      reply = await parsed(response);
    } catch {
      listeners.lost();
      throw gone();
    }
    if (!response.ok) throw new ApiError(response.status, reply);
    if (Number.isFinite(reply.generation) && method !== 'GET') listeners.generation(reply.generation);
    return reply;
  }

  return {
    get: (path, limitMs) => json('GET', path, undefined, limitMs),
    post: (path, body) => json('POST', path, body),
    del: (path) => json('DELETE', path),
    async blob(path) {
      const response = await ask('GET', path);
      if (!response.ok) throw new ApiError(response.status, await parsed(response));
      const began = performance.now();
      const blob = await response.blob();
      return { blob, headers: response.headers, seconds: (performance.now() - began) / 1000 };
    },
  };
}
