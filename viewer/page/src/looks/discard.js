// Removes objects from pictures.

/** Removes an object from the picture and frees its geometry and material. @param {Data | undefined} object a mesh, or points */
export function discard(object) {
  object?.removeFromParent();
  object?.geometry.dispose();
  object?.material.dispose();
}
