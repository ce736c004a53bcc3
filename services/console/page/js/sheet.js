// @ts-check
/**
 * Opens a sheet that covers the page; STOP is in it while it is open.
 * @param {HTMLDialogElement} dialog
 * @param {{get: (section: string) => any, set: (section: string, value: any) => void}} store
 */
export function openSheet(dialog, store) {
  if (dialog.open) return;
  dialog.addEventListener("close", () => store.set("cover", null), { once: true });
  dialog.showModal();
  store.set("cover", dialog);
}
