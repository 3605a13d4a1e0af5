// Pages that are opened from the disk.
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

/** Opens a file as a reader does, without a network; asked: the addresses of its requests, errors: its console. */
export async function openFile(t, file, dark) {
  const context = await t.browser.newContext({
    viewport: { width: 1100, height: 800 },
    colorScheme: dark ? 'dark' : 'light',
    offline: true,
  });
  const page = await context.newPage();
  const asked = [];
  const errors = [];
  page.on('request', (request) => asked.push(request.url()));
  page.on('console', (message) => errors.push(message.text()));
  page.on('pageerror', (error) => errors.push(error.message));
  await page.goto(pathToFileURL(file).href);
  return { page, asked, errors, close: () => context.close() };
}

/** A folder for files of a test, removed at the end. */
export async function withFolder(act) {
  const folder = mkdtempSync(join(tmpdir(), 'cuvette-html-'));
  try {
    await act(folder);
  } finally {
    rmSync(folder, { recursive: true });
  }
}
