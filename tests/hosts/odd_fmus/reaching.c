/* What it can reach: y = 1 it lists the folder TRIED_FOLDER, 2 it writes there, 4 an address of the host (its port is the
   input u), 8 it may signal another process, 16 a Unix socket with the path TRIED_SOCKET, 32 one of that name without a
   file. */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "small.h"

static int lists(const char *folder) {
  DIR *opened = opendir(folder);
  int found = 0;
  while (opened && readdir(opened)) found++;
  if (opened) closedir(opened);
  return found > 2; /* more than itself and its parent */
}

static int writes(const char *name) {
  int file = open(name, O_CREAT | O_WRONLY, 0600);
  if (file >= 0) close(file);
  return file >= 0;
}

static int connects(int port) {
  struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  int s = socket(AF_INET, SOCK_STREAM, 0), reached = s >= 0 && !connect(s, (struct sockaddr *)&address, sizeof address);
  if (s >= 0) close(s);
  return reached;
}

static int joins(int is_abstract) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  strcpy(address.sun_path + is_abstract, TRIED_SOCKET);
  socklen_t size = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + is_abstract + strlen(TRIED_SOCKET));
  int s = socket(AF_UNIX, SOCK_STREAM, 0), reached = s >= 0 && !connect(s, (struct sockaddr *)&address, size);
  if (s >= 0) close(s);
  return reached;
}

static int signals(int first) { /* any process but itself, its guard and what holds both */
  for (int pid = first; pid < first + 100000; pid++)
    if (pid != getpid() && pid != getppid() && !kill(pid, 0)) return 1;
  return 0;
}

static fmi2Status advance(small *s, double end) {
  s->time = end;
  s->y = lists(TRIED_FOLDER) + 2 * writes(TRIED_FOLDER "/written") + 4 * connects((int)s->u) + 8 * signals(10) +
         16 * joins(0) + 32 * joins(1);
  return fmi2OK;
}
