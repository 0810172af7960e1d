# One image for the service and for the workers; the command chooses.
#   docker build -t shapewright .
#   docker run -p 8000:8000 -v shapewright:/data shapewright          service and worker, embedded default

FROM node:22-bookworm-slim AS dashboard
WORKDIR /src/service/dashboard
COPY service/dashboard/package.json service/dashboard/package-lock.json ./
RUN npm ci --no-audit --no-fund
COPY openapi /src/openapi
COPY examples/goblet.ply /src/examples/goblet.ply
COPY service/dashboard ./
RUN npm run build

FROM python:3.11-slim-bookworm AS packages
# pip finds torch where it is configured to; give a CPU index here to keep several GB of CUDA packages out:
#   docker build --build-arg PIP_EXTRA_INDEX_URL=... .
ARG PIP_EXTRA_INDEX_URL
ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1
RUN python -m venv /opt/shapewright
WORKDIR /src
COPY requirements/run.lock requirements/run.lock
RUN /opt/shapewright/bin/pip install -r requirements/run.lock
COPY pyproject.toml README.md ./
COPY shapewright shapewright
COPY models_store models_store
COPY workers workers
COPY cli cli
COPY service service
COPY --from=dashboard /src/service/dashboard/dist service/dashboard/dist
RUN /opt/shapewright/bin/pip install --no-deps --no-build-isolation .

FROM python:3.11-slim-bookworm
RUN apt-get update \
    && apt-get install -y --no-install-recommends libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri libgles2 \
    && rm -rf /var/lib/apt/lists/* \
    && useradd --uid 10001 --user-group --create-home shapewright \
    && install -d -o shapewright -g shapewright /data /opt/numba
COPY --from=packages /opt/shapewright /opt/shapewright
ENV PATH=/opt/shapewright/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    NUMBA_CACHE_DIR=/opt/numba \
    SHAPEWRIGHT_DATA_DIR=/data
USER shapewright
# kernels compiled for the processor that builds the image; another kind compiles its own when they are first called
RUN python -m shapewright.classification.warm_up && python -m shapewright.estimation.fast.warm_up
WORKDIR /data
VOLUME /data
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=5s --start-period=30s \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8000/readyz', timeout=4)"]
CMD ["shapewright", "serve", "--host", "0.0.0.0", "--port", "8000"]
