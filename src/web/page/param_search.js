/* The search for parameters by words of their path, their description or everyday language, as of `cuvette params`.
 * exports: findParams(lab, text, near) -> promise of rows, best first; equally good ones of the set near first */

export async function findParams(lab, text, near = new Set()) {
  const { found } = await lab.get(`/api/params?find=${encodeURIComponent(text)}`);
  return found
    .flatMap((paths) => [...paths.filter((path) => near.has(path)), ...paths.filter((path) => !near.has(path))])
    .map(lab.param)
    .filter(Boolean);
}
