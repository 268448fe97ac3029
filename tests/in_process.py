"""What a study is handed to work with, in this process and without a journal."""


class InProcess:
    """Evaluates points here, one after the other; one that fails is a row with its reason."""

    def map(self, function, points, what="points", keep=()):
        return [{name: point[name] for name in keep} | self.one(function, point) for point in points]

    def one(self, function, point):
        try:
            return function(point)
        except Exception as error:
            return {"failed": str(error)}

    def alone(self):
        return self

    def say(self, fraction):
        pass

    def tell(self, words):
        self.told = words
