// A web server for plain files, as any host of static pages: GET of files, nothing else.
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.jpg': 'image/jpeg',
  '.wasm': 'application/wasm',
};

/** folder: what is served; made: {PATH: async () => text or bytes}, which replace files; sent(path): called for each
 * file. */
export async function serveSite(folder, made = {}, sent = () => {}) {
  const server = createServer(async (request, reply) => {
    const { pathname } = new URL(request.url, 'http://site');
    const path = decodeURIComponent(pathname.endsWith('/') ? `${pathname}index.html` : pathname);
    try {
      const content = made[path] ? await made[path]() : await readFile(join(folder, normalize(path)));
      sent(path);
      reply.writeHead(200, { 'Content-Type': TYPES[extname(path)] ?? 'application/octet-stream' });
      reply.end(request.method === 'HEAD' ? undefined : content);
    } catch {
      reply.writeHead(404, { 'Content-Type': 'text/plain' });
      reply.end('no such file');
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    origin: `http://127.0.0.1:${server.address().port}`,
    close: () => new Promise((resolve) => (server.closeAllConnections(), server.close(resolve))),
  };
}
