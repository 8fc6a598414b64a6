"""Analysis of a System: linear models, steady and periodic motions."""
