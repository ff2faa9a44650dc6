// Requests to the server that this page came from, and to no other.

let csrf = "";

export async function session() {
  const answer = await fetch("/api/session", { cache: "no-store" });
  if (!answer.ok) throw new Error(await reason(answer));
  const said = await answer.json();
  csrf = said.csrf;
  return said;
}

/** Ask for something; raises an Error with the server's reason where it refuses. */
export async function post(path, body = {}) {
  let answer;
  try {
    answer = await fetch(`/api/${path}`, {
      method: "POST",
      headers: { "Content-Type": "application/json", "X-Hostkit-Token": csrf },
      body: JSON.stringify(body),
    });
  } catch {
    throw new Error("hostkit does not answer");
  }
  if (!answer.ok) throw new Error(await reason(answer));
}

export async function recordings() {
  const answer = await fetch("/api/recordings", { cache: "no-store" });
  if (!answer.ok) throw new Error(await reason(answer));
  const said = await answer.json();
  return Array.isArray(said) ? said : (said.recordings ?? []);
}

async function reason(answer) {
  try {
    const said = await answer.json();
    if (typeof said.error === "string") return said.error;
  } catch {
    // no JSON: the status has to do
  }
  return answer.status === 401
    ? "not allowed: open the address that hostkit printed"
    : `refused with status ${answer.status}`;
}
