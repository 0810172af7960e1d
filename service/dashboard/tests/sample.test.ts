import { describe, expect, it } from "vitest";

import { ApiError } from "../src/api/problem";
import { fetchSample } from "../src/lib/sample";

describe("the sample", () => {
  it("comes as a file that the service reads by its name", async () => {
    const asked: string[] = [];
    const file = await fetchSample(async (url) => {
      asked.push(url);
      return new Response("ply\n");
    });
    expect(asked[0]).toMatch(/goblet.*\.ply$/);
    expect([file.name, await file.text()]).toEqual(["goblet.ply", "ply\n"]);
  });

  it("says what is wrong when it cannot be had", async () => {
    await expect(fetchSample(async () => new Response("gone", { status: 404 }))).rejects.toBeInstanceOf(ApiError);
    await expect(fetchSample(() => Promise.reject(new TypeError("failed")))).rejects.toMatchObject({ status: 0 });
  });
});
