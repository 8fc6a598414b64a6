/* Copies between arrays of several instances and one array with the numbers of all lanes interleaved. Blocks of as many
 * numbers as there are lanes form a square matrix of vectors, which is transposed in registers. */
#ifndef ALI3_LANE_COPIES_H
#define ALI3_LANE_COPIES_H
#ifdef ALI3_WIDTH
typedef real unaligned_real __attribute__((aligned(8)));

/* One pass of a transposition: the two results of exchanging blocks of `distance` numbers of a and b. */
#if ALI3_WIDTH == 8
#define ALI3_LOW(a, b, distance)                                                                                       \
  (distance == 1   ? __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)                                          \
   : distance == 2 ? __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13)                                           \
                   : __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11))
#define ALI3_HIGH(a, b, distance)                                                                                      \
  (distance == 1   ? __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)                                          \
   : distance == 2 ? __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15)                                         \
                   : __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15))
#elif ALI3_WIDTH == 4
#define ALI3_LOW(a, b, distance)                                                                                       \
  (distance == 1 ? __builtin_shufflevector(a, b, 0, 4, 2, 6) : __builtin_shufflevector(a, b, 0, 1, 4, 5))
#define ALI3_HIGH(a, b, distance)                                                                                      \
  (distance == 1 ? __builtin_shufflevector(a, b, 1, 5, 3, 7) : __builtin_shufflevector(a, b, 2, 3, 6, 7))
#else
#define ALI3_LOW(a, b, distance) __builtin_shufflevector(a, b, 0, 2)
#define ALI3_HIGH(a, b, distance) __builtin_shufflevector(a, b, 1, 3)
#endif

/* Transposes in log2(ALI3_WIDTH) passes. */
static inline void transpose(real square[ALI3_WIDTH]) {
#pragma GCC unroll 3
  for (int distance = 1; distance < ALI3_WIDTH; distance *= 2)
#pragma GCC unroll 8
    for (int i = 0; i < ALI3_WIDTH; i++) {
      if (i & distance) continue;
      const real a = square[i], b = square[i + distance];
      square[i] = ALI3_LOW(a, b, distance);
      square[i + distance] = ALI3_HIGH(a, b, distance);
    }
}

/* n numbers of each lane -> `to`, where number i of all lanes is contiguous. */
static void interleave(double *to, const double *const lane[], int32_t n) {
  int32_t i = 0;
  for (; i + ALI3_WIDTH <= n; i += ALI3_WIDTH) {
    real square[ALI3_WIDTH];
    for (int l = 0; l < ALI3_WIDTH; l++) square[l] = *(const unaligned_real *)(lane[l] + i);
    transpose(square);
    for (int l = 0; l < ALI3_WIDTH; l++) *(unaligned_real *)(to + (i + l) * ALI3_WIDTH) = square[l];
  }
  for (; i < n; i++)
    for (int l = 0; l < ALI3_WIDTH; l++) to[i * ALI3_WIDTH + l] = lane[l][i];
}

/* The inverse of `interleave`. */
static void separate(double *const lane[], const double *from, int32_t n) {
  int32_t i = 0;
  for (; i + ALI3_WIDTH <= n; i += ALI3_WIDTH) {
    real square[ALI3_WIDTH];
    for (int l = 0; l < ALI3_WIDTH; l++) square[l] = *(const unaligned_real *)(from + (i + l) * ALI3_WIDTH);
    transpose(square);
    for (int l = 0; l < ALI3_WIDTH; l++) *(unaligned_real *)(lane[l] + i) = square[l];
  }
  for (; i < n; i++)
    for (int l = 0; l < ALI3_WIDTH; l++) lane[l][i] = from[i * ALI3_WIDTH + l];
}
#endif
#endif
