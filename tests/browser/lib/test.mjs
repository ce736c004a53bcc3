// What every test of the page has: a group of its own, and two promises that are checked behind it:
// no request left the machine, and the page reported no error.

import { test as base, expect } from "@playwright/test";
import { Group } from "./group.mjs";

export { expect };

export const test = base.extend({
  /** Settings of the group, `key=value` each. */
  settings: [[], { option: true }],

  /** Whether the group has a copy of the configuration, for a test that changes its files. */
  ownConfig: [false, { option: true }],

  /** Errors that this test provokes: texts that may be among those that the page reports. */
  provoked: [[], { option: true }],

  group: async ({ settings, ownConfig }, use) => {
    const group = await Group.up(settings, undefined, ownConfig);
    await use(group);
    await group.down();
  },

  /** Watches every page of the context; checked when the test has ended. */
  watched: async ({ context, provoked }, use) => {
    const strangers = [];
    const errors = [];
    const isOwn = (url) => ["127.0.0.1", "localhost", ""].includes(new URL(url).hostname);
    const isProvoked = (text) => provoked.some((part) => text.includes(part));
    context.on("request", (request) => isOwn(request.url()) || strangers.push(request.url()));
    context.on("weberror", (error) => errors.push(String(error.error())));
    context.on("console", (message) => {
      if (message.type() === "error" && !isProvoked(message.text())) errors.push(message.text());
    });
    await use(undefined);
    expect(strangers, "requests that left the machine").toEqual([]);
    expect(errors, "errors that the page reported").toEqual([]);
  },

  /** A page on the console, connected. */
  console: async ({ page, group, watched }, use) => {
    void watched;
    await page.goto(group.link());
    await use(page);
  },
});
