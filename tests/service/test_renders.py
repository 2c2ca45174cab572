from conftest import ask, finish
from fastapi.testclient import TestClient


def test_a_render_runs_to_its_end(client: TestClient) -> None:
    job = finish(client, ask(client))
    print(job)
    assert job["status"] == "successful"
