process.stdout.write(JSON.stringify(process.versions.node));
