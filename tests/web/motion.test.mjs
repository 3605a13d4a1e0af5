// The motion of a slime next to theory: the numbers of `cuvette motion`, stop, refusals, and the panel Slime.

const SCENE = 'scenes/slime.yaml';
const lasting = ({ name }) => !/^rate\.(step_s|simulated)/.test(name);
const stripped = (slimes) => slimes.map((slime) => ({ ...slime, values: slime.values.filter(lasting) }));

/** The last digits of sines differ in a browser, whose module has the C library of emscripten; errors are differences
 * of nearly equal numbers. */
function near(t, slimes, expected) {
  for (const [i, { values, ...slime }] of slimes.entries()) {
    const { values: others, ...other } = expected[i];
    t.equal(slime, other, 'slime');
    for (const [k, { measured, theory, error, ...value }] of values.entries()) {
      const { measured: alike, theory: same, error: off, ...words } = others[k];
      t.equal(value, words, 'value');
      t.near(measured, alike, 1e-6 * Math.max(1e-3, Math.abs(alike)), `${value.name}: measured`);
      t.near(theory, same, 1e-9 * Math.max(1e-3, Math.abs(same)), `${value.name}: theory`);
    }
  }
}

export const cases = {
  'the numbers are those of the command line': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/set', { set: { 'toy.level': 2, 'toy.integrator': 'verlet' } });
    const found = await lab.get('/api/motion');
    const words = ['--set', 'toy.level=2', '--set', 'toy.integrator=verlet'];
    const written = JSON.parse(await lab.run('motion', SCENE, '--json', ...words));
    t.equal([found.schema, found.scene], [written.schema, written.scene], 'schema and scene');
    const [values, expected] = [stripped(found.slimes), stripped(written.slimes)];
    if (t.engine === 'server') t.equal(values, expected, 'values');
    else near(t, values, expected);
    t.equal(found.slimes[0].values.length, written.slimes[0].values.length, 'number of values');
  },

  'a measurement is stopped, and a scene without a slime is refused': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/set', { set: { 'toy.level': 6, 'toy.integrator': 'implicit' } });
    const reply = lab.ask('GET', '/api/motion');
    const stopping = setInterval(() => lab.post('/api/motion/stop', {}), 300);
    const { status, bytes } = await reply;
    clearInterval(stopping);
    t.equal(status, 409, 'status of a stopped measurement');
    t.match(Buffer.from(bytes).toString(), /the measurement was stopped/, 'stopped');
    await lab.post('/api/open', { file: 'scenes/rod.yaml' });
    const none = await lab.ask('GET', '/api/motion');
    t.equal(none.status, 409, 'status without a slime');
    t.match(Buffer.from(none.bytes).toString(), /it has no slime/, 'without a slime');
  },

  'the panel shows the table': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/set', { set: { 'toy.level': 2 } });
    const screen = await t.open(lab, { width: 1366, height: 900, dark: true });
    await screen.showPanel('Slime');
    const part = screen.page
      .getByRole('tabpanel', { name: 'Slime' })
      .locator('details')
      .filter({ hasText: 'Motion and theory' });
    await part.locator('summary').click();
    await part.getByRole('button', { name: 'Measure' }).click();
    await part.getByText('toy: level 2, euler, steps of 0.001 s').waitFor();
    await screen.quiet();
    t.equal(await part.locator('tbody tr').count(), 19, 'rows');
    await part.scrollIntoViewIfNeeded();
    await t.axe(screen, 'motion and theory');
    await t.image(screen, 'slime-motion');
    const [saved] = await Promise.all([
      screen.page.waitForEvent('download'),
      part.getByRole('button', { name: 'Save table' }).click(),
    ]);
    t.equal(saved.suggestedFilename(), 'slime-motion.csv', 'name of the table');
  },
};
