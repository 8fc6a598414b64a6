// Types that JavaScript cannot declare; read by the type check only.

/** JSON or options whose keys are not checked. */
type Data = Record<string, any>;

/** The class of an element that `el` makes: the tag's name is before the first dot. */
type ElementOf<Tag extends string> = Tag extends `${infer Name}.${string}`
  ? ElementOf<Name>
  : Tag extends keyof HTMLElementTagNameMap
    ? HTMLElementTagNameMap[Tag]
    : HTMLElement;

declare module "*.css" {
  const text: string;
  export default text;
}
