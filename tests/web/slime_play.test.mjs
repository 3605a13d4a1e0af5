// The slime on the page: it plays, is dragged through the image by pointer and by keys, and its colours change while it
// moves.

const slime = async (lab) => (await lab.get('/api/state')).slime;

/** The panel with the slime playing. */
async function play(t, options) {
  const lab = await t.lab('scenes/slime.yaml');
  await lab.post('/api/set', { set: { 'toy.script': '', 'toy.time_s': 0 } });
  const screen = await t.open(lab, options);
  await screen.showPanel('Slime');
  await screen.button('Play').click();
  await screen.until(() => window.lab.slime.playing && window.lab.slime.time_s > 0.1);
  return { lab, screen };
}

/** Waits until a condition on the received state is true. */
const until = (screen, condition) => screen.until(condition);

export const cases = {
  'the pointer grabs and pulls the slime': async (t) => {
    const { lab, screen } = await play(t);
    await screen.chooseTool('Grab');
    const [a, b] = [await screen.place(400, 330), await screen.place(330, 250)];
    await screen.page.mouse.move(a.x, a.y);
    await screen.page.mouse.down();
    await until(screen, () => window.lab.slime.held > 0);
    await screen.page.mouse.move(b.x, b.y, { steps: 8 });
    await screen.page.mouse.wheel(0, -60);
    await until(screen, () => window.lab.slime.speed > 1);
    t.more(await screen.page.locator('.layer-grab circle').count(), 1, 'markers of the hand');
    await t.image(screen, 'slime-drawn');
    await screen.page.mouse.up();
    await until(screen, () => window.lab.slime.held === 0);
    t.equal(await screen.page.locator('.layer-grab circle').count(), 0, 'markers after the release');
    t.equal((await slime(lab)).trouble, null, 'the error of the slime');
  },

  'keys grab and pull the slime': async (t) => {
    const { screen } = await play(t);
    await screen.chooseTool('Grab');
    await screen.stage.focus();
    await screen.page.keyboard.press('ArrowDown');
    await screen.page.keyboard.press('Enter');
    await until(screen, () => window.lab.slime.held > 0);
    for (const key of ['ArrowRight', 'ArrowRight', 'ArrowUp', 'PageDown']) await screen.page.keyboard.press(key);
    await screen.page.keyboard.press('Enter');
    await until(screen, () => window.lab.slime.held === 0);
    await screen.page.keyboard.press('Enter');
    await until(screen, () => window.lab.slime.held > 0);
    await screen.chooseTool('Orbit');
    await until(screen, () => window.lab.slime.held === 0);
    t.check(true, 'choosing another tool releases the slime');
  },

  'changing a colour keeps the motion, and changing the body restarts it': async (t) => {
    const { lab, screen } = await play(t);
    const { time_s: then } = await slime(lab);
    await screen.page.getByLabel('Absorption, red', { exact: true }).press('End');
    await until(screen, () => window.lab.param('body.absorb_per_m').value[0] === 100);
    await screen.until((time_s) => window.lab.slime.time_s > time_s, then);
    t.more((await slime(lab)).time_s, then, 'its time advances');
    await screen.page.getByLabel('Tint', { exact: true }).fill('#ff8000');
    await until(screen, () => window.lab.param('body.absorb_per_m').value[0] === 0);
    const [red, green, blue] = await lab.value('body.absorb_per_m');
    t.equal(red, 0, 'the absorption of red by an orange tint, 1/m');
    t.near(Math.exp(-green), ((128 / 255 + 0.055) / 1.055) ** 2.4, 0.001, 'the transmittance of green over 1 m');
    t.more(blue, 5, 'the absorption of blue, 1/m');
    const { generation } = await lab.get('/api/state');
    await screen.page.getByLabel('Damping', { exact: true }).press('ArrowRight');
    await screen.until(
      (g) => window.lab.state.generation > g && window.lab.slime.time_s < window.lab.state.slime.time_s + 1,
      generation,
    );
    t.equal((await slime(lab)).trouble, null, 'the error after the restart');
    await screen.button('Pause').click();
    await until(screen, () => !window.lab.slime.playing);
    await screen.button('Off').click();
    await until(screen, () => !window.lab.slime.on);
    await screen.settled();
  },

  'the panel, light and dark': async (t) => {
    for (const dark of [false, true]) {
      const { screen } = await play(t, { dark });
      await screen.button('Pause').click();
      await until(screen, () => !window.lab.slime.playing);
      await t.axe(screen, dark ? 'slime, dark' : 'slime, light');
      await t.image(screen, `slime-${dark ? 'dark' : 'light'}`);
    }
  },

  'a scene without a slime': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Slime');
    t.equal(await screen.page.getByRole('radio', { name: 'Grab' }).count(), 0, 'radio buttons of the tool Grab');
    await t.axe(screen, 'no slime');
  },
};
