// What went wrong, as the service tells it (RFC 9457), or as the page saw it.

export class Problem extends Error {
  /**
   * @param {object} told title, detail, status, errors: [{pointer, detail}] as in RFC 9457
   * @param {boolean} unreachable the service did not answer at all
   */
  constructor({ title = "", detail = "", status = 0, errors = [] }, unreachable = false) {
    super(title || detail);
    this.title = title;
    this.detail = detail;
    this.status = status;
    this.errors = Array.isArray(errors) ? errors : [];
    this.unreachable = unreachable;
  }

  /** The problem in an answer that is not a success; an answer without a problem body keeps its status line. */
  static async from(response) {
    const type = response.headers.get("content-type") ?? "";
    if (type.includes("json")) {
      try {
        return new Problem(await response.json());
      } catch {
        // A body that is cut off: the status line below is all there is.
      }
    }
    return new Problem({ title: `${response.status} ${response.statusText}`.trim(), status: response.status });
  }

  /** The errors whose pointer is the given one or lies below it. */
  at(pointer) {
    return this.errors.filter((e) => e.pointer === pointer || e.pointer?.startsWith(`${pointer}/`));
  }
}
