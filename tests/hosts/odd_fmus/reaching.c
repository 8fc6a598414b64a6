/* What it can reach at 0.01 s: y = 1 the folder / home has the name that the environment gave, 2 a file beside the FMU's
   folder, 4 an address of the host (its port is the input u), 8 another process. */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <sys/socket.h>
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

static int signals(int first) { /* any process but itself, its guard and what holds both */
  for (int pid = first; pid < first + 100000; pid++)
    if (pid != getpid() && pid != getppid() && !kill(pid, 0)) return 1;
  return 0;
}

static fmi2Status advance(small *s, double end) {
  s->time = end;
  s->y = lists(TRIED_FOLDER) + 2 * writes(TRIED_FOLDER "/written") + 4 * connects((int)s->u) + 8 * signals(10);
  return fmi2OK;
}
