// Numbers that come as text.

function bytes(text) {
  return Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
}

function singles(text) {
  return new Float32Array(bytes(text).buffer);
}
