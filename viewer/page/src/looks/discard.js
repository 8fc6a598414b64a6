/** Takes a thing out of the picture and frees what it is drawn with. @param {Data | undefined} thing a mesh, or points */
export function discard(thing) {
  thing?.removeFromParent();
  thing?.geometry.dispose();
  thing?.material.dispose();
}
