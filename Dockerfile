# The service, installed from the same hashed locks as `make install`, run by a user who owns nothing but the data.
#
#   docker build -t isogyre .
#   docker run --rm -p 127.0.0.1:8000:8000 -v isogyre-data:/data isogyre
#
# The service has no API keys yet: publish its port on loopback, or behind something that knows its visitors.

FROM python:3.12-slim AS build
ENV PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_CACHE_DIR=1
WORKDIR /src
# What the build needs stays in an environment of its own and out of the image.
COPY requirements/runtime.txt requirements/build.txt requirements/
RUN python -m venv /opt/builder \
 && /opt/builder/bin/python -m pip install --quiet --require-hashes -r requirements/build.txt \
 && python -m venv /opt/isogyre \
 && /opt/isogyre/bin/python -m pip install --quiet --require-hashes -r requirements/runtime.txt
COPY pyproject.toml README.md LICENSE ./
COPY crystal_core crystal_core
COPY minerals_db minerals_db
COPY service service
COPY web web
RUN /opt/builder/bin/python -m hatchling build -t wheel -d dist \
 && /opt/isogyre/bin/python -m pip install --quiet --no-deps --no-index dist/isogyre-*.whl

FROM python:3.12-slim
COPY --from=build /opt/isogyre /opt/isogyre
RUN useradd --uid 10001 --home-dir /data --create-home --shell /usr/sbin/nologin isogyre
ENV PATH=/opt/isogyre/bin:$PATH ISOGYRE_DATA_DIR=/data PYTHONUNBUFFERED=1
VOLUME /data
WORKDIR /data
USER 10001:10001
EXPOSE 8000
HEALTHCHECK --interval=30s --timeout=5s --start-period=60s --retries=3 \
  CMD ["python", "-c", "import urllib.request as r; r.urlopen('http://127.0.0.1:8000/readyz', timeout=4)"]
CMD ["isogyre", "serve", "--host", "0.0.0.0", "--port", "8000"]
