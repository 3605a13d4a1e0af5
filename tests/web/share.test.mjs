// A link that holds the scene: copied from one page, opened by another, it gives the same film; undo goes back.
export const cases = {
  'a link reproduces the film': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const film = () => screen.page.evaluate(() => window.lab.picture.film_hash);
    const first = await film();
    await screen.setNumber('liquid.ior', 1.6);
    const changed = await film();
    t.equal(changed === first, false, 'the change alters the film');
    const { fragment, code } = await lab.get('/api/link');
    const { generation } = await lab.get('/api/state');
    await lab.post('/api/undo', {});
    await screen.settled(generation + 1);
    t.equal(await film(), first, 'the film after undo');
    await screen.page.evaluate((hash) => (location.hash = hash), fragment + code);
    await screen.page.reload();
    await screen.settled(generation + 2);
    t.equal(await film(), changed, 'the film of the link');
    t.equal(await screen.page.evaluate(() => location.hash), '', 'the address no longer has the scene');
    t.equal((await lab.get('/api/state')).file, null, 'the scene of a link has no file');
  },
};
