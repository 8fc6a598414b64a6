// Types that JavaScript has no words for; read by the type check only.

/** JSON from outside or options, with keys that are not checked here. */
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
