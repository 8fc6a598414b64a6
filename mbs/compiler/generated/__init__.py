"""C code for the algebra of one System: the sums of the kernel's loops, in their order, written out."""
