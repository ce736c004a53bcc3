// @ts-check
/**
 * Says the size of an element, now and whenever it or the screen's sharpness changes.
 * @param {HTMLElement} element
 * @param {(size: {width: number, height: number, screen: number}) => void} changed `screen`: pixels
 *   of the screen per pixel of the page
 */
export function watchSize(element, changed) {
  let box = { width: 0, height: 0 };
  const say = () => {
    const { width, height } = box;
    if (width >= 1 && height >= 1) changed({ width, height, screen: devicePixelRatio || 1 });
  };
  new ResizeObserver(([{ contentRect }]) => {
    box = contentRect;
    say();
  }).observe(element);
  const sharpness = () => {
    const same = matchMedia(`(resolution: ${devicePixelRatio}dppx)`);
    same.addEventListener("change", () => [say(), sharpness()], { once: true });
  };
  sharpness();
}

/**
 * Says whether anybody can see an element.
 * @param {HTMLElement} element
 * @param {(seen: boolean) => void} changed
 */
export function watchSeen(element, changed) {
  let isInView = false;
  const say = () => changed(isInView && !document.hidden);
  new IntersectionObserver((entries) => {
    isInView = entries.at(-1)?.isIntersecting ?? false;
    say();
  }).observe(element);
  document.addEventListener("visibilitychange", say);
}

/**
 * Says whether the page is dark, now and whenever that changes.
 * @param {HTMLElement} element
 * @param {(dark: boolean) => void} changed
 */
export function watchTheme(element, changed) {
  const say = () => changed(isDark(element));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", say);
  new MutationObserver(say).observe(document.documentElement, { attributes: true });
  say();
}

/**
 * Returns whether text on the element is light, that is, whether the page is dark for any reason.
 */
function isDark(element) {
  const [r, g, b] = (getComputedStyle(element).color.match(/[\d.]+/g) ?? ["0", "0", "0"]).map(
    Number,
  );
  return 0.3 * r + 0.6 * g + 0.1 * b > (Math.max(r, g, b) <= 1 ? 0.5 : 128);
}
