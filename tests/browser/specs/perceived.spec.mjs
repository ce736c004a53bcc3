// Objects from perception: the page shows those that are on the table, where they are.

import { distance, drawn, shown } from "../lib/arm.mjs";
import { WITH_PICTURE } from "../lib/chromium.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

test.use({ settings: ["group.perception.enabled=true"] });

test("perceived objects are drawn where they are, and vanish", async ({ console: page, group }) => {
  const put = async (kind, ...at) => (await group.json("objects", "add", kind, "--at", ...at)).name;
  const white = await put("white", "0.7", "0.2", "-0.12");
  await put("metal", "0.7", "-0.2", "-0.12");
  await expect(page.getByRole("meter")).toHaveCount(2);
  await drawn(page);
  const expectAt = (places) =>
    expect
      .poll(async () => {
        const { objects } = await shown(page);
        const apart = objects.map((place, n) => distance(place, places[n] ?? [9, 9, 9]));
        return objects.length === places.length && Math.max(...apart) < 0.002;
      })
      .toBe(true);
  const metal = [0.7, -0.2, -0.12];
  await expectAt([[0.7, 0.2, -0.12], metal]);

  await group.must("objects", "move", white, "--at", "0.6", "0.35", "-0.12");
  await expectAt([[0.6, 0.35, -0.12], metal]);

  await group.must("objects", "remove", white);
  await expect(page.getByRole("meter")).toHaveCount(1);
  await expectAt([metal]);

  await put("white", "0.65", "0.1", "-0.12");
  await expect(page.getByRole("meter")).toHaveCount(2);
  await expectAt([metal, [0.65, 0.1, -0.12]]);
});
