// The picture and the list are of one belief.

import { WITH_PICTURE } from "../lib/chromium.mjs";
import { Fed } from "../lib/fed.mjs";
import { NEW, STATES } from "../lib/states.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

test("the picture has the list's probabilities, and what tells objects apart", async ({ page }) => {
  const fed = await Fed.open(page);
  fed.state(STATES.fetching);
  const label = page.locator(".arm-label").filter({ hasText: /^clear/ });
  await expect(label).toHaveText("clear 96%");
  // The scene's belief begins anew; both show the one at the hand-over until that can no longer be refused.
  fed.state(STATES.delivered);
  await expect(page.locator("#question")).toHaveAttribute("data-kind", "delivered");
  const card = page.locator(".card").filter({ hasText: NEW }).locator(".percent");
  await expect(label).toHaveText(`clear ${await card.textContent()}`);
});
