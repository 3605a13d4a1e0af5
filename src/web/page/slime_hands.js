/* Hands that hold the slime, one per pointer or key. Moves are sent one after the other; the newest
 * replaces a waiting one.
 * exports: createHands(lab, changed) -> {all(), take(key, x, y), get(key), drop(key), dropAll()}
 *   take: positions in pixels of the full image; a hand is {x, y, depth, where ([x,y,z] of the grab point, null
 *   before),
 *   move(x, y, depth)}
 *   changed() is called when a hand is added, moved or removed */

/* Errors that the user cannot avoid: the slime restarted, or the page is being closed. */
const gone = (error) => error.status === 409 || error.status === 404 || error.status === 0 || error.status === 401;

async function playing(lab) {
  if (!lab.slime?.on) await lab.post('/api/slime', { do: 'play' });
}

export function createHands(lab, changed) {
  const hands = new Map();

  addEventListener('pagehide', () => {
    for (const hand of hands.values()) hand.leave();
  });
  return { all: () => [...hands.values()], take, get: (key) => hands.get(key), drop, dropAll };

  function take(key, x, y) {
    drop(key);
    const hand = { x, y, depth: 0, where: null, number: null, held: true, dirty: false, sending: true };
    hand.move = (nextX, nextY, depth) => {
      Object.assign(hand, { x: nextX, y: nextY, depth: depth ?? hand.depth, dirty: true });
      changed();
      send(hand);
    };
    /* A page that is being closed cannot wait for a reply. */
    hand.leave = () => {
      if (hand.number !== null) {
        lab.engine
          .fetch('/api/slime/release', {
            method: 'POST',
            keepalive: true,
            headers: { 'Content-Type': 'application/json' },
            body: JSON.stringify({ hand: hand.number }),
          })
          .catch(() => undefined);
      }
    };
    hands.set(key, hand);
    changed();
    hold(key, hand, x, y);
    return hand;
  }

  async function hold(key, hand, x, y) {
    try {
      await playing(lab);
      const reply = await lab.post('/api/slime/grab', { x, y });
      hand.number = reply.hand;
      hand.where = reply.where;
      changed();
    } catch (error) {
      forget(key, hand);
      if (error.status === 404) lab.say('No slime at that point');
      else lab.fail(error);
      return;
    }
    hand.sending = false;
    if (hand.held) send(hand);
    else release(hand);
  }

  async function send(hand) {
    if (hand.sending) return;
    hand.sending = true;
    try {
      while (hand.dirty && hand.held) {
        hand.dirty = false;
        await lab.post('/api/slime/move', { hand: hand.number, x: hand.x, y: hand.y, depth: hand.depth });
      }
    } catch (error) {
      for (const [key, one] of hands) if (one === hand) forget(key, hand);
      if (!gone(error)) lab.fail(error);
      return;
    }
    hand.sending = false;
    if (!hand.held) release(hand);
  }

  function forget(key, hand) {
    hand.held = false;
    if (hands.get(key) === hand) hands.delete(key);
    changed();
  }

  function release(hand) {
    if (hand.number === null) return;
    const { number } = hand;
    hand.number = null;
    lab.post('/api/slime/release', { hand: number }).catch((error) => {
      if (!gone(error)) lab.fail(error);
    });
  }

  function drop(key) {
    const hand = hands.get(key);
    if (!hand) return;
    forget(key, hand);
    if (!hand.sending) release(hand);
  }

  function dropAll() {
    for (const key of [...hands.keys()]) drop(key);
  }
}
