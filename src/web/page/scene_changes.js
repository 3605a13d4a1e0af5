/* The scene of /api/scene?since=GENERATION: what differs from that generation is applied to the page's copy.
 * exports: applyScene(known, reply) -> scene: the reply itself if it is whole; known is not altered. */

export function applyScene(known, reply) {
  if (reply.since === undefined) return reply;
  const { since, order, params, ...parts } = reply;
  const rows = new Map(known.params.map((row) => [row.path, row]));
  for (const row of params) rows.set(row.path, row);
  const paths = order || known.params.map((row) => row.path);
  return { ...known, ...parts, params: paths.map((path) => rows.get(path)) };
}
