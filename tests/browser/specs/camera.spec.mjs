// A camera's picture beside or instead of the drawn one.

import { createServer } from "node:http";
import { drawn } from "../lib/arm.mjs";
import { expectAccessible } from "../lib/axe.mjs";
import { WITH_PICTURE } from "../lib/chromium.mjs";
import { Group } from "../lib/group.mjs";
import { t } from "../lib/strings.mjs";
import { expect, test } from "../lib/test.mjs";

test.use(WITH_PICTURE);

const PICTURE = Buffer.from(
  "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==",
  "base64",
);

/** A camera that sends a stream at `/stream`, and single pictures elsewhere; counts what it sent. */
const base = test.extend({
  camera: async ({ settings }, use) => {
    void settings;
    const camera = { sent: 0, isDown: false, port: 0 };
    const server = createServer((request, response) => {
      if (camera.isDown) return response.writeHead(503).end();
      camera.sent += 1;
      if (!request.url?.startsWith("/stream")) {
        return response.writeHead(200, { "content-type": "image/png" }).end(PICTURE);
      }
      response.writeHead(200, { "content-type": "multipart/x-mixed-replace; boundary=part" });
      const head = `--part\r\ncontent-type: image/png\r\ncontent-length: ${PICTURE.length}\r\n\r\n`;
      const frame = () =>
        response.write(Buffer.concat([Buffer.from(head), PICTURE, Buffer.from("\r\n")]));
      frame();
      const timer = setInterval(frame, 100);
      response.on("close", () => clearInterval(timer));
      return response;
    });
    await new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(undefined)));
    camera.port = server.address().port;
    await use(camera);
    server.closeAllConnections();
    server.close();
  },

  group: async ({ camera, settings }, use) => {
    const own = settings.map((setting) => setting.replace("PORT", String(camera.port)));
    const group = await Group.up(own);
    await use(group);
    await group.down();
  },
});

const show = (page, source) =>
  page
    .getByRole("group", { name: t("camera.source") })
    .getByRole("radio", { name: t(`camera.source.${source}`) })
    .check();
const shown = (page) => page.locator('.camera[data-state="shown"] .camera-image');

base.describe("a stream", () => {
  base.use({
    settings: ["console.camera=http://127.0.0.1:PORT/stream"],
    provoked: ["503"],
  });

  base(
    "is shown instead of the model or beside it, as was chosen",
    async ({ console: page, camera }) => {
      await drawn(page);
      await expect(page.locator(".camera")).toBeHidden();
      expect(camera.sent, "nobody looks at it").toBe(0);
      await show(page, "camera");
      await expect(shown(page)).toBeVisible();
      await expect(page.locator(".arm-stage")).toBeHidden();
      await expectAccessible(page);
      await show(page, "both");
      await expect(shown(page)).toBeVisible();
      await expect(page.locator(".arm-stage")).toBeVisible();
      await expectAccessible(page);
      camera.isDown = true;
      await page.reload();
      const notice = page.locator(".camera-notice");
      await expect(notice).toHaveText(t("camera.failed", { host: `127.0.0.1:${camera.port}` }));
      camera.isDown = false;
      await expect(shown(page)).toBeVisible();
      await expect(notice).toBeHidden();
    },
  );
});

base.describe("single pictures", () => {
  base.use({
    settings: ["console.camera=http://127.0.0.1:PORT/now.png", "console.camera_every_s=0.1"],
  });

  base("are fetched one after the other while they are seen", async ({ console: page, camera }) => {
    await show(page, "camera");
    await expect(shown(page)).toBeVisible();
    await expect.poll(() => camera.sent).toBeGreaterThan(3);
  });
});
