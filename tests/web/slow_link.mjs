// A link of limited rate and with latency between a page and a laboratory, for the bench: all connections of one
// direction share the rate, as those of one household do.
import { createServer, connect } from 'node:net';

/** Passes on pieces of at most a packet's size, each when the link is free again, and late by the latency. */
class Direction {
  constructor(bytesPerS, latencyMs) {
    Object.assign(this, { bytesPerS, latencyMs, free: 0, bytes: 0 });
  }

  carry(from, to) {
    from.on('data', (piece) => {
      const now = performance.now();
      this.bytes += piece.length;
      this.free = Math.max(this.free, now) + (1000 * piece.length) / this.bytesPerS;
      from.pause(); /* one piece of a connection is under way at a time */
      setTimeout(() => from.resume(), this.free - now);
      setTimeout(() => to.writable && to.write(piece), this.free - now + this.latencyMs);
    });
    from.on('end', () => setTimeout(() => to.end(), Math.max(0, this.free - performance.now()) + this.latencyMs));
    from.on('error', () => to.destroy());
  }
}

/** down, up: of what the page receives and sends, with their counts of bytes. */
export class SlowLink {
  static async open(port, { bitsPerS, latencyMs }) {
    const link = new SlowLink();
    link.down = new Direction(bitsPerS / 8, latencyMs / 2);
    link.up = new Direction(bitsPerS / 8, latencyMs / 2);
    link.server = createServer((near) => {
      const far = connect({ port, host: '127.0.0.1', noDelay: true });
      near.setNoDelay(true);
      link.up.carry(near, far);
      link.down.carry(far, near);
    });
    await new Promise((resolve) => link.server.listen(0, '127.0.0.1', resolve));
    link.port = link.server.address().port;
    return link;
  }

  close() {
    this.server.close();
  }
}
