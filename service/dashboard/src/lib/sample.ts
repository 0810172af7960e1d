/** The mesh that ships to be tried: a goblet as a careless scanner would hand it over. */
import { ApiError } from "../api/problem";
import gobletUrl from "../../../../examples/goblet.ply?url";

/** Fetch the sample as a file, as if it had been dropped on the page. */
export async function fetchSample(fetcher: (url: string) => Promise<Response> = fetch): Promise<File> {
  let response: Response;
  try {
    response = await fetcher(gobletUrl);
  } catch (thrown) {
    throw ApiError.from(thrown);
  }
  if (!response.ok) throw ApiError.fromAnswer(response.status, response.statusText, await response.text());
  return new File([await response.blob()], SAMPLE_NAME);
}

export const SAMPLE_NAME = "goblet.ply";
