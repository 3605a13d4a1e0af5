// Accessibility of every panel, light and dark, on small to large screens: axe reports no violation, and no element is
// wider than the window.

async function everyPanel(t, how) {
  const name = `${how.width}x${how.height}, ${how.dark ? 'dark' : 'light'}`;
  const lab = await t.lab(how.scene ?? 'scenes/rod.yaml');
  const screen = await t.open(lab, how);
  const tabs = await screen.panelNames();
  t.check(tabs.length > 5, `${name}: ${tabs.length} panels`);
  for (const tab of tabs) {
    await screen.showPanel(tab);
    await screen.settled();
    await screen.quiet();
    await t.axe(screen, `${name}, panel ${tab}`);
    const over = await screen.page.evaluate(
      () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
    );
    t.check(over <= 0, `${name}, panel ${tab}: the page is ${over} pixels wider than the window`);
  }
}

export const cases = {
  'a laptop, light': (t) => everyPanel(t, { width: 1366, height: 768 }),
  'a laptop, dark': (t) => everyPanel(t, { width: 1366, height: 768, dark: true }),
  'a large screen, light': (t) => everyPanel(t, { width: 1920, height: 1080 }),
  'a large screen, dark': (t) => everyPanel(t, { width: 1920, height: 1080, dark: true }),
  'a narrow window, light': (t) => everyPanel(t, { width: 800, height: 900, scene: 'scenes/slime.yaml' }),
  'a narrow window, dark': (t) => everyPanel(t, { width: 800, height: 900, dark: true, scene: 'scenes/slime.yaml' }),
  'the button for the dark theme': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const colour = () => screen.page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const light = await colour();
    await screen.button('Dark theme').click();
    const dark = await colour();
    t.check(light !== dark, `the button does not change the background, ${light}`);
    await t.axe(screen, 'the dark theme chosen by the button');
    await screen.load();
    t.equal(await colour(), dark, 'the dark theme after reloading');
  },
};
