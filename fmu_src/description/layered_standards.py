"""Manifests of the FMI layered standards that an FMU follows."""

from xml.etree import ElementTree

NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"


def manifest(tag: str, **named: str) -> ElementTree.Element:
    """Root of a manifest; `named`: its attributes, without the prefix ``fmi-ls-`` that all of them have."""
    ElementTree.register_namespace("fmi-ls", NAMESPACE)
    return ElementTree.Element(tag, {f"{{{NAMESPACE}}}fmi-ls-{name}": value for name, value in named.items()})
