// The checks of a case: counts passed checks and keeps a line for each failed one. A failed check does not end its
// case.

export class Checks {
  constructor() {
    this.passed = 0;
    this.failures = [];
  }

  check(ok, what) {
    if (ok) this.passed++;
    else this.failures.push(String(what).replaceAll(/\s*\n\s*/g, ' '));
    return Boolean(ok);
  }

  equal(found, expected, what) {
    const [a, b] = [JSON.stringify(found), JSON.stringify(expected)];
    return this.check(a === b, `${what}: ${a}, not ${b}`);
  }

  near(found, expected, within, what) {
    return this.check(Math.abs(found - expected) <= within, `${what}: ${found}, not ${expected} within ${within}`);
  }

  less(found, bound, what) {
    return this.check(found < bound, `${what}: ${found}, not less than ${bound}`);
  }

  more(found, bound, what) {
    return this.check(found > bound, `${what}: ${found}, not more than ${bound}`);
  }

  match(text, pattern, what) {
    return this.check(pattern.test(text), `${what}: ${JSON.stringify(text)} does not match ${pattern}`);
  }

  /** Passes if the list of errors is empty. */
  none(wrong, what) {
    return this.check(
      wrong.length === 0,
      `${what}: ${wrong.slice(0, 8).join('; ')}${wrong.length > 8 ? `; and ${wrong.length - 8} more` : ''}`,
    );
  }
}
