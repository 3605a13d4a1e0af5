// Accessibility of every panel in use, light and dark: axe reports no violation.

const size = { width: 1440, height: 900 };

async function show(t, screen, name) {
  await screen.settled();
  await screen.quiet();
  await t.axe(screen, name);
  await t.image(screen, name);
}

async function optics(t, dark) {
  const theme = dark ? 'dark' : 'light';
  const lab = await t.lab('scenes/rod.yaml');
  const screen = await t.open(lab, { ...size, dark });
  const { page } = screen;
  await screen.setNumber('liquid.ior', 1.5);
  await (await screen.paramSlider('liquid.ior')).focus();
  await show(t, screen, `parameters-${theme}`);

  await page.getByRole('searchbox', { name: /Find a parameter/ }).fill('shadow');
  await page.getByText('Descriptions').click();
  await page
    .getByRole('tabpanel', { name: 'Parameters' })
    .getByText('2 found')
    .or(page.getByText(/^\d+ found$/))
    .first()
    .waitFor();
  await show(t, screen, `search-${theme}`);
  await page.getByText('Descriptions').click();
  await page.getByRole('searchbox', { name: /Find a parameter/ }).fill('');

  await screen.chooseTool('Inspect');
  await screen.clickPixel(440, 470);
  await page.getByRole('treegrid', { name: 'Rays of the pixel' }).getByRole('row').nth(3).waitFor();
  await show(t, screen, `pixel-${theme}`);

  await screen.chooseTool('Light');
  await show(t, screen, `light-${theme}`);

  await screen.chooseTool('Object');
  await page.getByRole('tabpanel', { name: 'Objects' }).getByRole('button', { name: /^rod/ }).click();
  await show(t, screen, `objects-${theme}`);

  await screen.chooseTool('Orbit');
  await screen.showPanel('Compare');
  await screen.button('Pin as A').click();
  await screen.until(() => window.lab.state.reference);
  const { generation } = await lab.post('/api/set', {
    set: { 'liquid.medium': 'water', 'liquid.absorb_per_m': [1.5, 0.4, 0.1] },
  });
  await screen.settled(generation);
  await page
    .getByRole('tabpanel', { name: 'Compare' })
    .getByText(await page.evaluate(() => window.lab.image.film_hash))
    .waitFor();
  await show(t, screen, `compare-${theme}`);
  await page.getByText('Difference', { exact: true }).click();
  await show(t, screen, `difference-${theme}`);

  await screen.showPanel('Machine');
  await page.getByText(t.engine === 'server' ? 'Kernel' : 'cuvette machine', { exact: true }).waitFor();
  await show(t, screen, `machine-${theme}`);
}

async function toy(t, dark) {
  const lab = await t.lab('scenes/slime.yaml');
  const screen = await t.open(lab, { ...size, dark });
  await screen.showPanel('Slime');
  await screen.button('Play').click();
  await screen.until(() => window.lab.slime.time_s > 1.5);
  await screen.button('Pause').click();
  await screen.until(() => !window.lab.slime.playing && window.lab.image.final);
  await show(t, screen, `toy-${dark ? 'dark' : 'light'}`);
}

async function study(t, dark) {
  const lab = await t.lab('scenes/rod.yaml');
  await lab.run('study', 'run', '--quiet', 'studies/brief.study');
  const screen = await t.open(lab, { ...size, dark });
  await screen.showPanel('Studies');
  await screen.page.locator('.plot-marker').first().waitFor();
  await show(t, screen, `studies-${dark ? 'dark' : 'light'}`);
}

export const cases = {
  'optics, light': (t) => optics(t, false),
  'optics, dark': (t) => optics(t, true),
  'the slime, light': (t) => toy(t, false),
  'the slime, dark': (t) => toy(t, true),
  'a study, light': (t) => study(t, false),
  'a study, dark': (t) => study(t, true),
};
