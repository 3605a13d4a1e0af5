// Closed-form references for rendered images, independent of the program.

/** For a camera that looks horizontally along z: the image column of the ray with slope u = x / z, in pixels from the
 * left. */
export function columnOfSlope(u, { width, height, fovDeg }) {
  const halfHeight = Math.tan((fovDeg * Math.PI) / 360);
  return ((u / ((halfHeight * width) / height) + 1) / 2) * width;
}

/** A ray from the eye at (0, -distance) along (u, 1) into a disc of that radius and index about the origin: x where
 * the ray, refracted once by Snell's law, reaches the plane z = depth. NaN if it misses the disc. */
export function reachInDisc(u, { distance, radius, index, depth }) {
  const length = Math.hypot(u, 1);
  const [dx, dz] = [u / length, 1 / length];
  // |eye + t d|^2 = radius^2
  const along = dz * distance;
  const room = along * along - distance * distance + radius * radius;
  if (room < 0) return NaN;
  const t = along - Math.sqrt(room);
  const [px, pz] = [t * dx, t * dz - distance];
  const [nx, nz] = [px / radius, pz / radius];
  const cosIn = -(dx * nx + dz * nz);
  const sinOut = Math.sqrt(1 - cosIn * cosIn) / index;
  const cosOut = Math.sqrt(1 - sinOut * sinOut);
  const [rx, rz] = [dx / index + (cosIn / index - cosOut) * nx, dz / index + (cosIn / index - cosOut) * nz];
  return px + ((depth - pz) / rz) * rx;
}

/** The slope at which x = edge is seen; x increases with the slope in the searched range. */
export function slopeOfEdge(edge, disc) {
  const rim = disc.radius / Math.sqrt(disc.distance * disc.distance - disc.radius * disc.radius);
  let [low, high] = [-0.7 * rim, 0.7 * rim];
  for (let i = 0; i < 60; i++) {
    const middle = (low + high) / 2;
    if (reachInDisc(middle, disc) < edge) low = middle;
    else high = middle;
  }
  return (low + high) / 2;
}

const minus = (a, b) => a.map((v, i) => v - b[i]);
const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.sqrt(dot(a, a)));

/** For an upright camera: from (x, y) in the image, in pixels from its upper left corner, to the ray's direction, and
 * back. */
export function camera({ position, target, fovDeg, width, height }) {
  const forward = unit(minus(target, position));
  const right = unit(cross([0, 1, 0], forward));
  const up = cross(forward, right);
  const halfHeight = Math.tan((fovDeg * Math.PI) / 360);
  const halfWidth = (halfHeight * width) / height;
  return {
    direction: (x, y) => {
      const [a, b] = [((2 * x) / width - 1) * halfWidth, (1 - (2 * y) / height) * halfHeight];
      return forward.map((f, i) => f + a * right[i] + b * up[i]);
    },
    project: (point) => {
      const away = minus(point, position);
      const z = dot(away, forward);
      return {
        x: ((dot(away, right) / z / halfWidth + 1) / 2) * width,
        y: ((1 - dot(away, up) / z / halfHeight) / 2) * height,
      };
    },
  };
}

const hitsBall = (from, direction, { centre, radius }, until) => {
  const d = unit(direction);
  const away = minus(centre, from);
  const along = dot(away, d);
  return along > 0 && along < until && dot(away, away) - along * along < radius * radius;
};

/** Whether the floor (y = 0) is seen at (x, y) and the ball occludes the lamp there. */
export function inShadow(x, y, { eye, view, ball, lamp }) {
  const d = view.direction(x, y);
  if (d[1] >= 0) return false;
  const t = -eye[1] / d[1];
  if (hitsBall(eye, d, ball, Infinity)) return false;
  const floor = eye.map((v, i) => v + t * d[i]);
  const toLamp = minus(lamp, floor);
  return hitsBall(floor, toLamp, ball, Math.sqrt(dot(toLamp, toLamp)));
}
