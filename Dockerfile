# A checkout in which everything works: `make test`, `make demo`, and the command `serendipity`.
#
#     docker build -t serendipity .          # or podman
#     docker run --rm serendipity make test
#     docker run --rm serendipity serendipity plan --example room2 --discount 0.6
FROM debian:trixie-slim
RUN apt-get update \
 && apt-get install -y --no-install-recommends ca-certificates gcc libc6-dev make python3 python3-venv \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --create-home planner
USER planner
WORKDIR /home/planner/serendipity
COPY --chown=planner . .
RUN make .venv
ENV PATH="/home/planner/serendipity/.venv/bin:$PATH"
CMD ["serendipity", "--help"]
