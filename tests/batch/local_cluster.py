# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run a scheduler and two workers of Dask, which cannot read the files of tests that run as root.
The first argument is a folder for them. The script prints the address, then the processes of the
workers for each line of stdin. A second argument is the version that it pretends to have."""

import asyncio
import json
import os
import sys

NOBODY = 65534


def main():
    folder = sys.argv[1]
    if os.getuid() == 0:
        os.setgroups([])
        os.setgid(NOBODY)
        os.setuid(NOBODY)
    os.chdir(folder)
    import distributed

    if sys.argv[2:]:
        distributed.__version__ = sys.argv[2]
    asyncio.run(serve(folder, distributed))


async def serve(folder, distributed):
    async with distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=True,
        dashboard_address=None,
        asynchronous=True,
        local_directory=folder,
        host="127.0.0.1",
    ) as cluster:
        run_on_workers(cluster.scheduler.address)
        loop = asyncio.get_running_loop()
        while await loop.run_in_executor(None, sys.stdin.readline):
            run_on_workers(
                [
                    worker.process.pid
                    for worker in cluster.workers.values()
                    if worker.process is not None
                ]
            )


def run_on_workers(what):
    print(json.dumps(what), flush=True)


if __name__ == "__main__":
    main()
