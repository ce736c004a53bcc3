// @ts-check
import { h } from "../dom.js";

/**
 * The dialog in which a participant withdraws.
 * @param {(key: string) => string} t
 * @param {(deletes: boolean) => void} withdraw
 * @returns {HTMLDialogElement}
 */
export function withdrawDialog(t, withdraw) {
  const choose = (text, kind, press) => {
    const button = h("button", { type: "button", class: kind, text });
    button.addEventListener("click", () => {
      dialog.close();
      press?.();
    });
    return button;
  };
  const dialog = h(
    "dialog",
    { class: "study-dialog", "aria-labelledby": "withdraw-heading" },
    h("h2", { id: "withdraw-heading", class: "study-heading", text: t("study.withdraw.ask") }),
    h("p", { class: "study-lead", text: t("study.withdraw.more") }),
    choose(t("study.withdraw.stay"), "study-go", null),
    choose(t("study.withdraw.keep"), "", () => withdraw(false)),
    choose(t("study.withdraw.delete"), "study-danger", () => withdraw(true)),
  );
  document.body.append(dialog);
  return dialog;
}
