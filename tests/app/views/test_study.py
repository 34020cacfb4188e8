"""The published experiments without prior information."""

from streamlit.testing.v1 import AppTest

from tests.app.driving import PATIENCE_S


def test_the_study_page_makes_a_table_again():
    page = AppTest.from_function(study_page, default_timeout=PATIENCE_S).run()
    page.selectbox(key="study_table").set_value("3").run()
    page.number_input(key="study_replicates").set_value(10).run()
    page.button(key="study_run").click().run()
    assert not page.exception
    assert len(page.dataframe[0].value) > 50
    assert any("Table 3" in text.value for text in page.markdown)


def study_page():
    from app.views import study

    study.show()
