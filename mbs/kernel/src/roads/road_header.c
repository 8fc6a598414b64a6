/* Checks of the header of a road file. */
#include "road_header.h"

#include <math.h>
#include <string.h>

#include "../files/crc32.h"
#include "shared_tile.h"

/* Indices into the reals, see road_file.h. */
enum { PLANE_GRADE_X = 1, PLANE_GRADE_Y, PLANE_FRICTION, KERB_STEP = 2, KERB_SIDE, KERB_FRICTION };
enum { GRID_X0, GRID_Y0, GRID_DX, GRID_DY, GRID_FRICTION };
static const double STEEPEST = 10.0; /* largest grade of a plane */
enum { POINTS = ALI3_ROAD_TILE * ALI3_ROAD_TILE, MAX_POINTS = 1 << 30 };

/* NULL, or what is wrong with the numbers of a plane or kerb. */
static const char *find_plane_or_kerb_problem(const ali3_road_header *h) {
  const double *p = h->real, friction = p[h->kind == ALI3_FILE_PLANE ? PLANE_FRICTION : KERB_FRICTION];
  if (h->nx != 0 || h->ny != 0 || h->maps != 0 || h->contents != 0) return "a plane or kerb has no grid";
  for (int i = 0; i < ALI3_ROAD_REALS; i++)
    if (!(fabs(p[i]) <= ALI3_ROAD_FARTHEST)) return "a number in its header is not finite or beyond 1e8";
  if (!(friction >= 0.0 && friction <= ALI3_ROAD_FRICTION)) return "its friction lies outside 0 to 10";
  if (h->kind == ALI3_FILE_PLANE && !(fabs(p[PLANE_GRADE_X]) <= STEEPEST && fabs(p[PLANE_GRADE_Y]) <= STEEPEST))
    return "a grade of it lies outside -10 to 10";
  if (h->kind == ALI3_FILE_KERB && !(p[KERB_STEP] > 0.0)) return "the step of its kerb is not positive";
  if (h->kind == ALI3_FILE_KERB && p[KERB_SIDE] != 1.0 && p[KERB_SIDE] != -1.0)
    return "the side of its kerb is neither 1 nor -1";
  return NULL;
}

const char *ali3_road_grid_problem(const ali3_road_header *h) {
  const double *p = h->real;
  if (h->tile != ALI3_ROAD_TILE || (h->maps != 1 && h->maps != 2)) return "its tiles have another form";
  if (h->nx < 2 || h->ny < 2 || h->nx > MAX_POINTS || h->ny > MAX_POINTS ||
      (double)h->nx * (double)h->ny > ALI3_ROAD_POINTS)
    return "its grid has fewer than 2 x 2 or more than 1e12 points";
  if (!(p[GRID_DX] > 0.0 && p[GRID_DY] > 0.0)) return "the spacing of its grid is not positive";
  if (!(fabs(p[GRID_X0]) <= ALI3_ROAD_FARTHEST && fabs(p[GRID_Y0]) <= ALI3_ROAD_FARTHEST &&
        (double)h->nx * p[GRID_DX] <= ALI3_ROAD_FARTHEST && (double)h->ny * p[GRID_DY] <= ALI3_ROAD_FARTHEST))
    return "its grid reaches farther than 1e8 m";
  if (!(p[GRID_FRICTION] >= 0.0 && p[GRID_FRICTION] <= ALI3_ROAD_FRICTION)) return "its friction lies outside 0 to 10";
  return NULL;
}

int64_t ali3_road_tiles_along(int64_t points) { return (points + ALI3_ROAD_TILE - 1) / ALI3_ROAD_TILE; }

size_t ali3_road_tile_bytes(const ali3_road_header *h) {
  return (size_t)h->maps * POINTS * sizeof(double) + ALI3_ROAD_TRAILER;
}

const char *ali3_road_header_problem(const unsigned char *bytes, int64_t size, ali3_road_header *h, uint32_t *version,
                                     uint32_t *crc) {
  static const unsigned char one[4] = {1, 0, 0, 0};
  uint32_t machine;
  memcpy(&machine, one, sizeof machine);
  memcpy(version, bytes + 8, sizeof *version);
  memcpy(crc, bytes + 12, sizeof *crc);
  memcpy(h, bytes + 16, sizeof *h);
  if (machine != 1) return "this machine is not little endian";
  if (memcmp(bytes, "ALI3ROAD", 8) != 0)
    return "it is not a road file; make one of a CSV table, NumPy arrays, pictures or a TOML file by: ali3 road INPUT "
           "OUTPUT.road";
  if (size < ALI3_ROAD_HEADER) return "it ends too early: it was cut off";
  if (*version != ALI3_ROAD_VERSION && *version != ALI3_ROAD_SHARED)
    return "its version is not 1 or 2, which this kernel reads; use a newer ALi3 or FMU, or write it again with ali3 "
           "road";
  if (*crc != ali3_crc32(bytes + 16, ALI3_ROAD_HEADER - 16)) return "its header was altered or damaged";
  if (h->kind < ALI3_FILE_PLANE || h->kind > ALI3_FILE_GRID) return "it has an unknown kind of road";
  const char *error = h->kind == ALI3_FILE_GRID ? ali3_road_grid_problem(h) : find_plane_or_kerb_problem(h);
  if (error != NULL) return error;
  const int64_t tiles = h->kind == ALI3_FILE_GRID ? ali3_road_tiles_along(h->nx) * ali3_road_tiles_along(h->ny) : 0;
  const int shared = *version == ALI3_ROAD_SHARED;
  const int64_t min_size = ALI3_ROAD_HEADER + tiles * (shared ? ALI3_TILE_ENTRY : (int64_t)ali3_road_tile_bytes(h));
  const int64_t full_size = shared ? h->size : min_size;
  if (h->size != full_size || full_size < min_size) return "its header contradicts itself";
  return size == full_size  ? NULL
         : size < full_size ? "it ends too early: it was cut off"
                            : "it is longer than its header says";
}
