/* Reads the TAP report of node --test, prints what failed or was skipped, and the line "N passed, N failed". */

import { createInterface } from 'node:readline';

let passed = 0;
let failed = 0;
let last = '';
let shown = false; /* the lines of a failure */
for await (const line of createInterface({ input: process.stdin })) {
  const [, indent, no, name] = line.match(/^( *)(not )?ok \d+ - (.*)$/) ?? [];
  if (/^ *# Subtest/.test(line)) shown = false;
  if (indent === undefined) {
    if (shown && /(error|expected|actual|code):|^ +\S/.test(line)) console.log(line);
    if (/^ *\.\.\.$/.test(line)) shown = false;
    if (/^ *type: 'suite'/.test(line)) last === 'failed' ? failed-- : passed--; /* a suite is none of the tests */
    continue;
  }
  shown = Boolean(no);
  const skipped = name.includes('# SKIP');
  last = no ? 'failed' : 'passed';
  if (no) failed++;
  else if (!skipped) passed++;
  if (no || skipped) console.log(line.trim());
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed || !passed ? 1 : 0);
