// What a case finds: checks that passed, and a line for each that did not. A check that fails does not end its case.

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

  equal(found, wanted, what) {
    const [a, b] = [JSON.stringify(found), JSON.stringify(wanted)];
    return this.check(a === b, `${what}: ${a}, not ${b}`);
  }

  near(found, wanted, within, what) {
    return this.check(Math.abs(found - wanted) <= within, `${what}: ${found}, not ${wanted} within ${within}`);
  }

  more(found, bound, what) {
    return this.check(found > bound, `${what}: ${found}, not more than ${bound}`);
  }

  match(text, pattern, what) {
    return this.check(pattern.test(text), `${what}: ${JSON.stringify(text)} does not match ${pattern}`);
  }

  /** wrong: what is wrong, an array; passes when it is empty. */
  none(wrong, what) {
    return this.check(
      wrong.length === 0,
      `${what}: ${wrong.slice(0, 8).join('; ')}${wrong.length > 8 ? `; and ${wrong.length - 8} more` : ''}`,
    );
  }
}
